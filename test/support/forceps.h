#pragma once

#include <string>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
constexpr double kJawThickness = 0.008;  // m
constexpr double kJawOpening = 0.064;    // m between both jaws at a value of zero

/** Two plates that face each other along x, each sliding inwards by its own joint, "left" and
 * "right", by at most 2 cm; between them, above, the tool frame. */
inline Linkage forcepsLinkage()
{
  Linkage linkage("palm");
  const double x = 0.5 * (kJawOpening + kJawThickness);
  for (const double side : {-1.0, 1.0})
  {
    const std::string name = side < 0.0 ? "left" : "right";
    Link jaw;
    jaw.coordinate = linkage.add(Coordinate{name, 0.0, 0.02, 0.5});
    jaw.name = name + "_jaw";
    jaw.X_PJ.translation() = Vec3(side * x, 0.0, 0.0);
    jaw.kind = JointKind::sliding;
    jaw.axis_J = Vec3(-side, 0.0, 0.0);
    linkage.add(jaw);
  }
  return linkage;
}

/** The forceps with their frame here, as a tool "tool" that touches the tissue. */
inline ToolConfig& addForceps(SceneConfig& config, const Vec3& position, double friction)
{
  addTool(config, BoxShape{{kJawThickness, 0.04, 0.02}}, {position, Vec3::Zero()},
          Response::segment);
  config.contacts.back().friction = friction;
  config.contacts.back().stiffness_pa_per_m = 2e6;
  ToolConfig& tool = config.tools.back();
  tool.linkage = forcepsLinkage();
  tool.shapes.push_back(tool.shapes[0]);
  tool.shapes[0].link = 1;
  tool.shapes[1].link = 2;
  return tool;
}

/** Both jaws at the same value. */
inline JointValues closedBy(double value)
{
  return JointValues::Constant(2, value);
}

inline Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

}  // namespace soft_tissue::test
