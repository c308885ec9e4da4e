#include "sagging_beam.h"

#include <cmath>
#include <cstdlib>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue::studies
{
namespace
{
constexpr double kYoungModulus = 5000.0, kPoissonRatio = 0.45, kDensity = 1000.0;
const Vec3 kSize(0.1, 0.02, 0.02);
constexpr double kNear = 1e-9;  // m

std::vector<double> lumpedMasses(const TetMesh& rest)
{
  std::vector<double> masses(rest.nodes.size(), 0.0);
  addLumpedMasses(rest, std::vector<double>(rest.tets.size(), kDensity), 0, masses);
  return masses;
}
}  // namespace

std::string beamMesh(const std::string& folder, int thousands)
{
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  const bool given = thousands == 1 || thousands == 5 || thousands == 20;
  if (data != nullptr && given)
  {
    return std::string(data) + "/beams/beam" + std::to_string(thousands) + "k.msh";
  }
  const std::string file = folder + "/beam" + std::to_string(thousands) + "k.msh";
  const std::size_t tets = thousands > 0 ? 1000 * static_cast<std::size_t>(thousands) : 240;
  saveGmsh(file, makeBox(cellsForBox(kSize, tets), kSize));
  return file;
}

SceneConfig beamScene(const BeamSetup& setup)
{
  SceneConfig config;
  config.file = "sagging beam";
  config.time_step_s = 0.01;
  config.gravity_m_per_s2 = Vec3(0.0, -setup.gravity_m_per_s2, 0.0);
  config.solver = setup.solver;
  TissueConfig tissue;
  tissue.name = "beam";
  tissue.mesh.file = setup.mesh;
  tissue.element = setup.element;
  tissue.material = {setup.law, kYoungModulus, kPoissonRatio, kDensity};
  tissue.fixed.push_back({Vec3(-kNear, -1.0, -1.0), Vec3(kNear, 1.0, 1.0)});
  config.tissues.push_back(tissue);
  return config;
}

std::vector<Index> beamTip(const Points& rest)
{
  std::vector<Index> tip;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const Vec3 to_high = (kSize - rest[i]).cwiseAbs();
    const Vec3 to_side = rest[i].cwiseAbs().cwiseMin(to_high);
    if (to_high.x() < kNear && to_side.tail<2>().maxCoeff() < kNear)
    {
      tip.push_back(static_cast<Index>(i));
    }
  }
  if (tip.size() != 4)
  {
    throw Error("the beam's end has " + std::to_string(tip.size()) + " corners instead of four");
  }
  return tip;
}

Vec3 meanWay(const std::vector<Index>& nodes, const Points& rest, const Points& x)
{
  Vec3 sum = Vec3::Zero();
  for (const Index node : nodes)
  {
    sum += x[node] - rest[node];
  }
  return sum / static_cast<double>(nodes.size());
}

std::vector<Index> clampedNodes(const Points& rest)
{
  std::vector<Index> nodes;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    if (std::abs(rest[i].x()) < kNear)
    {
      nodes.push_back(static_cast<Index>(i));
    }
  }
  return nodes;
}

StepResidual::StepResidual(const TetMesh& rest, const BeamSetup& setup)
    : masses_(lumpedMasses(rest)),
      fixed_(clampedNodes(rest.nodes)),
      elasticity_(
          rest, MaterialModel::corotated,
          std::vector<TetStiffnessParameters>(rest.tets.size(), {kYoungModulus, kPoissonRatio}), 0),
      gravity_(masses_, Vec3(0.0, -setup.gravity_m_per_s2, 0.0)),
      inertia_(masses_)
{}

double StepResidual::of(const Points& x, const Points& v, double step_s, const Points& after)
{
  inertia_.beginStep(0, static_cast<Index>(x.size()), {x, v, x, v},
                     StepFormula::implicitEuler(step_s));
  sum_.assign(x.size(), Vec3::Zero());
  const auto norm = [this](Points& forces) {
    for (const Index node : fixed_)
    {
      forces[node].setZero();
    }
    double squares = 0.0;
    for (const Vec3& force : forces)
    {
      squares += force.squaredNorm();
    }
    return std::sqrt(squares);
  };
  double acting = 0.0;
  EnergyTerm* const terms[] = {&gravity_, &inertia_, &elasticity_};
  for (EnergyTerm* term : terms)
  {
    term_.assign(x.size(), Vec3::Zero());
    term->addGradient(after, term_);
    acting += norm(term_);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      sum_[i] += term_[i];
    }
  }
  return norm(sum_) / acting;
}

}  // namespace soft_tissue::studies
