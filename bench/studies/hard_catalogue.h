#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hard_cases.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue::studies
{
constexpr double kLength = 0.06, kSide = 0.02;  // of the bar, m
inline const BoxConfig kFoot{Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)};

/** Builds cases, all of them from a bar along x whose end at x = 0 is fixed. */
class HardCatalogue
{
 public:
  explicit HardCatalogue(std::string folder) : folder_(std::move(folder)) {}

  std::vector<HardCase> cases;

  std::string save(const std::string& name, const TetMesh& mesh) const
  {
    const std::string file = folder_ + "/" + name + ".msh";
    saveGmsh(file, mesh);
    return file;
  }

  /** A case with the bar, or another mesh, in no gravity. */
  HardCase& add(const std::string& name, const std::string& file)
  {
    HardCase one;
    one.name = name;
    one.config.file = name;
    one.config.time_step_s = 0.01;
    one.config.gravity_m_per_s2.setZero();
    TissueConfig tissue;
    tissue.name = "body";
    tissue.mesh.file = file;
    tissue.material = {MaterialModel::neo_hookean, 5000.0, 0.4, 1000.0};
    one.config.tissues.push_back(tissue);
    cases.push_back(one);
    return cases.back();
  }

  HardCase& addBar(const std::string& name)
  {
    if (bar_.empty())
    {
      bar_ = save("bar", makeBox({6, 2, 2}, {kLength, kSide, kSide}));
    }
    HardCase& one = add(name, bar_);
    one.config.tissues[0].fixed.push_back(kFoot);
    return one;
  }

 private:
  std::string folder_, bar_;
};

inline TissueConfig& body(HardCase& one)
{
  return one.config.tissues[0];
}

/** Puts all nodes that aren't fixed where place(rest) says, at rest. */
template <typename Place>
void deform(Scene& scene, const Place& place)
{
  const TissueInfo& info = scene.tissues()[0];
  Points x = info.rest.nodes;
  for (Vec3& p : x)
  {
    p = place(p);
  }
  for (const Index node : info.fixed_nodes)
  {
    x[node] = info.rest.nodes[node];
  }
  scene.setMotion(0, x, Points(x.size(), Vec3::Zero()));
}

void addDrivenCases(HardCatalogue& all);
void addRealMeshes(HardCatalogue& all, const std::string& hard);
}  // namespace soft_tissue::studies
