#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>

#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/energy/viscosity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"
#include "support/mesh_file_content.h"

namespace soft_tissue
{
namespace
{
enum Evaluation
{
  kValue,
  kGradient,
  kExact,
  kPositive,
};

enum Viscous
{
  kElastic,
  kViscous,  // damped, and with a Prony series of two
};

/** One evaluation of a twisted block of 17 x 17 x 17 nodes, whatever its elements. */
void evaluate(benchmark::State& state, ElementKind kind, MaterialModel model, Viscous viscous)
{
  const QuadraticTetMesh quadratic = withEdgeNodes(makeBox({8, 8, 8}, {0.1, 0.1, 0.1}));
  const TetMesh fine = subdivided(quadratic);
  const auto count = static_cast<Index>(fine.nodes.size());
  std::unique_ptr<Elasticity> term;
  BlockMatrix hessian;
  if (kind == ElementKind::tet10)
  {
    term = std::make_unique<QuadraticTetElasticity>(
        quadratic, model,
        std::vector<TetStiffnessParameters>(quadratic.elements.size(), {5000.0, 0.45}), 0);
    hessian = BlockMatrix(nodeNeighbours(count, quadratic.elements));
  }
  else
  {
    term = std::make_unique<TetElasticity>(
        fine, model, std::vector<TetStiffnessParameters>(fine.tets.size(), {5000.0, 0.45}), 0);
    hessian = BlockMatrix(nodeNeighbours(count, fine.tets));
  }
  std::vector<EnergyTerm*> terms = {term.get()};
  const std::vector<TetStiffnessParameters> parameters(fine.tets.size(), {5000.0, 0.45});
  Viscosity viscosity(*term, parameters, {0.01, {{1.0, 0.1}, {0.5, 1.0}}});
  if (viscous == kViscous)
  {
    terms.push_back(&viscosity);
    viscosity.beginStep(fine.nodes, 0.005);
  }
  Points x = fine.nodes, gradient(x.size(), Vec3::Zero());
  for (Vec3& p : x)
  {
    p = Eigen::AngleAxisd(10.0 * p.z(), Vec3::UnitZ()) * p;
  }
  for (auto _ : state)
  {
    for (EnergyTerm* each : terms)
    {
      switch (state.range(0))
      {
        case kValue:
          benchmark::DoNotOptimize(each->value(x));
          break;
        case kGradient:
          benchmark::DoNotOptimize(each->valueAndGradient(x, gradient));
          break;
        default:
          each->addHessian(x, state.range(0) == kExact ? Curvature::exact : Curvature::positive,
                           hessian);
      }
    }
  }
  state.counters["nodes"] = static_cast<double>(count);
  state.counters["blocks"] = static_cast<double>(hessian.columns().size());
}

void evaluations(benchmark::internal::Benchmark* bench)
{
  bench->ArgName("what")->DenseRange(kValue, kPositive)->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(evaluate, neo_hookean_tet4, ElementKind::tet4, MaterialModel::neo_hookean,
                  kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, neo_hookean_tet10, ElementKind::tet10, MaterialModel::neo_hookean,
                  kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, corotated_tet4, ElementKind::tet4, MaterialModel::corotated, kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, corotated_tet10, ElementKind::tet10, MaterialModel::corotated, kElastic)
    ->Apply(evaluations);

BENCHMARK_CAPTURE(evaluate, neo_hookean_log_tet4, ElementKind::tet4, MaterialModel::neo_hookean_log,
                  kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, exponential_tet4, ElementKind::tet4, MaterialModel::exponential,
                  kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, st_venant_kirchhoff_tet4, ElementKind::tet4,
                  MaterialModel::st_venant_kirchhoff, kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, linear_tet4, ElementKind::tet4, MaterialModel::linear, kElastic)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, viscous_tet4, ElementKind::tet4, MaterialModel::neo_hookean, kViscous)
    ->Apply(evaluations);
BENCHMARK_CAPTURE(evaluate, viscous_tet10, ElementKind::tet10, MaterialModel::neo_hookean, kViscous)
    ->Apply(evaluations);

/** A beam of 100 x 20 x 20 mm with `cells` cubes over its thickness, clamped at x = 0, sagging. */
SceneConfig beam(const test::ScratchFolder& folder, ElementKind kind, int cells)
{
  SceneConfig config;
  config.file = "beam";
  config.time_step_s = 0.01;
  config.gravity_m_per_s2 = Vec3(0.0, -0.981, 0.0);
  TissueConfig tissue;
  tissue.name = "beam";
  tissue.element = kind;
  tissue.mesh.file = folder.path("beam.msh");
  saveGmsh(tissue.mesh.file, makeBox({5 * cells, cells, cells}, {0.1, 0.02, 0.02}));
  tissue.material = {MaterialModel::corotated, 5000.0, 0.45, 1000.0};
  tissue.fixed.push_back({Vec3(-1e-9, -1.0, -1.0), Vec3(1e-9, 1.0, 1.0)});
  config.tissues.push_back(tissue);
  return config;
}

/** Mean way of the four corners at the free end, m. */
Vec3 tipOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const Points& rest = scene.tissues()[0].rest.nodes;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const bool corner = rest[i].x() > 0.1 - 1e-9 && std::abs(rest[i].y() - 0.01) > 0.01 - 1e-9 &&
                        std::abs(rest[i].z() - 0.01) > 0.01 - 1e-9;
    sum += corner ? Vec3(0.25 * (snapshot.tissues[0].positions[i] - rest[i])) : Vec3(Vec3::Zero());
  }
  return sum;
}

/** Steps of 10 ms from straight on: the fall, with the error of the static tip beside it. */
void sag(benchmark::State& state, ElementKind kind)
{
  setThreadCount(1);
  const test::ScratchFolder folder;
  SceneConfig config = beam(folder, kind, static_cast<int>(state.range(0)));
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-6;
  config.solver.max_iterations = 200;
  Scene hanging(config);
  hanging.step();
  const Vec3 limit(-0.01909, -0.05624, 0.0);  // of other quadratic tets, see docs/accuracy.md
  state.counters["error_pct"] = 100.0 * (tipOf(hanging) - limit).norm() / limit.norm();
  config.solver = SolverConfig();
  Scene scene(config);
  int newton = 0, linear = 0;
  double fem = 0.0, solve = 0.0;
  for (auto _ : state)
  {
    const StepReport& report = scene.step();
    newton += report.newton_iterations;
    linear += report.linear_iterations;
    fem += report.ms.fem;
    solve += report.ms.solve;
  }
  const auto mean = [](double sum) {
    return benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
  };
  state.counters["nodes"] = static_cast<double>(scene.tissues()[0].rest.nodes.size());
  state.counters["newton"] = mean(newton);
  state.counters["linear"] = mean(linear);
  state.counters["fem_ms"] = mean(fem);
  state.counters["solve_ms"] = mean(solve);
}

BENCHMARK_CAPTURE(sag, tet10, ElementKind::tet10)
    ->ArgName("cells")
    ->DenseRange(1, 4)
    ->Iterations(100)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sag, tet4, ElementKind::tet4)
    ->ArgName("cells")
    ->Arg(2)
    ->Arg(4)
    ->Arg(8)
    ->Arg(12)
    ->Arg(16)
    ->Iterations(100)
    ->Unit(benchmark::kMillisecond);
}  // namespace
}  // namespace soft_tissue
