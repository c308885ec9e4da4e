#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
namespace
{
constexpr double kSpeed = 0.025;    // m/s, of the probe, as scripts/palpate.py presses
constexpr double kShallow = 0.003;  // m below the first touch
constexpr double kDeep = 0.005;     // m
constexpr double kPeriod = 2.0 * (kDeep - kShallow) / kSpeed;  // s
const Vec3 kStart(-0.012, 0.006, 0.042);                       // just above the nodule

std::string sourceFolder(const std::string&)
{
  return SOURCE_DIR;
}

/** @param quadratic_mesh  of quadratic tets, in place of the scene's own; empty: that */
SceneConfig loadScene(const std::string& name, const std::string& quadratic_mesh)
{
  SceneConfig config = loadSceneConfig(SOURCE_DIR "/config/scenes/" + name, &sourceFolder);
  if (!quadratic_mesh.empty())
  {
    config.tissues.at(0).mesh.file = SOURCE_DIR "/config/meshes/" + quadratic_mesh;
    config.tissues.at(0).element = ElementKind::tet10;
  }
  config.tools.at(0).initial_pose.position_m = kStart;
  return config;
}

/** The palpation's probe over the nodule, pressing on without ever letting go. */
class Press
{
 public:
  Press(const std::string& name, const std::string& quadratic_mesh)
      : scene_(loadScene(name, quadratic_mesh))
  {
    double z = kStart.z();
    while (stepTo(z).contacts == 0)
    {
      z -= kSpeed * timeStep();
    }
    touch_ = z;
    for (double depth = 0.0; depth < kDeep; depth += kSpeed * timeStep())
    {
      stepTo(touch_ - depth);
    }
    start_ = scene_.time();
  }

  double timeStep() const { return scene_.config().time_step_s; }
  const TetMesh& rest() const { return scene_.tissues().at(0).rest; }

  /** One step of a steady up and down between the two depths. */
  const StepReport& step()
  {
    const double phase = std::remainder(scene_.time() + timeStep() - start_, kPeriod) / kPeriod;
    return stepTo(touch_ - kDeep + 2.0 * std::abs(phase) * (kDeep - kShallow));
  }

 private:
  const StepReport& stepTo(double z)
  {
    Pose X_WT = Pose::Identity();
    X_WT.translation() = Vec3(kStart.x(), kStart.y(), z);
    scene_.setToolTarget(0, X_WT);
    return scene_.step();
  }

  Scene scene_;
  double touch_ = 0.0;  ///< height of the tip at the first touch, m
  double start_ = 0.0;  ///< simulated time at which the up and down begins, s
};

/** Counters are means of a step but for the real-time factor, of simulated over wall time. */
void report(benchmark::State& state, const Press& press, const StepReport& sum)
{
  const auto mean = [](double total) {
    return benchmark::Counter(total, benchmark::Counter::kAvgIterations);
  };
  state.counters["tets"] = static_cast<double>(press.rest().tets.size());
  state.counters["nodes"] = static_cast<double>(press.rest().nodes.size());
  state.counters["dt_ms"] = 1e3 * press.timeStep();
  state.counters["real_time_factor"] =
      benchmark::Counter(press.timeStep(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["fem_ms"] = mean(sum.ms.fem);
  state.counters["field_ms"] = mean(sum.ms.field);
  state.counters["detect_ms"] = mean(sum.ms.detect);
  state.counters["respond_ms"] = mean(sum.ms.respond);
  state.counters["solve_ms"] = mean(sum.ms.solve);
  state.counters["newton"] = mean(sum.newton_iterations);
  state.counters["linear"] = mean(sum.linear_iterations);
  state.counters["contacts"] = mean(sum.contacts);
}

void contactStep(benchmark::State& state, const std::string& scene,
                 const std::string& quadratic_mesh)
{
  setThreadCount(static_cast<int>(state.range(0)));
  Press press(scene, quadratic_mesh);
  StepReport sum;
  for (auto _ : state)
  {
    const StepReport& step = press.step();
    sum.ms.fem += step.ms.fem;
    sum.ms.field += step.ms.field;
    sum.ms.detect += step.ms.detect;
    sum.ms.respond += step.ms.respond;
    sum.ms.solve += step.ms.solve;
    sum.newton_iterations += step.newton_iterations;
    sum.linear_iterations += step.linear_iterations;
    sum.contacts += step.contacts;
  }
  report(state, press, sum);
  setThreadCount(1);
}

/** Ten times up and down. */
void measure(benchmark::internal::Benchmark* bench, double time_step_s)
{
  bench->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
  bench->Iterations(std::lround(10.0 * kPeriod / time_step_s));
}

BENCHMARK_CAPTURE(contactStep, lobe_5k, "palpation.yaml", "")->Apply([](auto* bench) {
  measure(bench, 0.005);
});
BENCHMARK_CAPTURE(contactStep, lobe_20k, "palpation_20k.yaml", "")->Apply([](auto* bench) {
  measure(bench, 0.01);
});
// Of quadratic tets.
BENCHMARK_CAPTURE(contactStep, lobe_1k_tet10, "palpation.yaml", "lobe_1k.msh")
    ->Apply([](auto* bench) { measure(bench, 0.005); });
BENCHMARK_CAPTURE(contactStep, lobe_5k_tet10, "palpation_20k.yaml", "lobe_5k.msh")
    ->Apply([](auto* bench) { measure(bench, 0.01); });
}  // namespace
}  // namespace soft_tissue
