#pragma once

#include <cmath>
#include <string>

#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"
#include "support/mesh_file_content.h"

namespace soft_tissue::test
{
constexpr double kBlockTop = 0.03;   // m
constexpr double kLobeTop = 0.0395;  // m, above kLobeSpot
inline const Vec3 kLobeSpot(-0.012, 0.0, 0.0);

/** A scene of one soft neo-Hookean tissue "tissue" and nothing else: no gravity, not fixed. */
inline SceneConfig tissueScene(const std::string& mesh_file)
{
  SceneConfig config;
  config.file = "small scene";
  config.time_step_s = 0.01;
  config.gravity_m_per_s2.setZero();
  TissueConfig tissue;
  tissue.name = "tissue";
  tissue.mesh.file = mesh_file;
  tissue.material = {MaterialModel::neo_hookean, 5000.0, 0.4, 1000.0};
  config.tissues.push_back(tissue);
  return config;
}

/** Fixes all nodes up to this height. */
inline void fixBelow(SceneConfig& config, double height)
{
  config.tissues[0].fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, height)});
}

/** A block of 60 x 60 x 30 mm on z = 0 around the z axis, cells[0] x cells[1] x cells[2]. */
inline SceneConfig blockScene(const ScratchFolder& folder, const std::array<int, 3>& cells)
{
  const std::string file = folder.path("block.msh");
  saveGmsh(file, makeBox(cells, {0.06, 0.06, kBlockTop}));
  SceneConfig config = tissueScene(file);
  config.tissues[0].pose.position_m = Vec3(-0.03, -0.03, 0.0);
  return config;
}

/** The lobe of about a thousand tets that the package brings along. */
inline SceneConfig lobeScene()
{
  return tissueScene(SOURCE_DIR "/config/meshes/lobe_1k.msh");
}

/** Adds a tool "tool" that follows setToolTarget() and touches the tissue. */
inline void addTool(SceneConfig& config, const ShapeGeometry& shape, const PoseConfig& start,
                    Response response)
{
  ToolConfig tool;
  tool.name = "tool";
  tool.shapes.push_back({shape, {}});
  tool.initial_pose = start;
  config.tools.push_back(tool);
  ContactConfig contact;
  contact.tissue = "tissue";
  contact.other = "tool";
  contact.response = response;
  contact.stiffness_pa_per_m = 5e6;
  config.contacts.push_back(contact);
}

/** How far a shape turned like this reaches below its origin, m. */
inline double reachDown(const ShapeGeometry& shape, const PoseConfig& pose)
{
  const Vec3 down = pose.toPose().linear().row(2).transpose().cwiseAbs();
  if (const auto* sphere = std::get_if<SphereShape>(&shape))
  {
    return sphere->radius_m;
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
  {
    return capsule->radius_m + 0.5 * capsule->length_m * down.z();
  }
  return 0.5 * down.dot(std::get<BoxShape>(shape).size_m);
}

/** The same pose `by` metres higher. */
inline Pose raised(Pose X, double by)
{
  X.translation().z() += by;
  return X;
}

}  // namespace soft_tissue::test
