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

SceneConfig loadScene(const std::string& name)
{
  SceneConfig config = loadSceneConfig(SOURCE_DIR "/config/scenes/" + name, &sourceFolder);
  config.tools.at(0).initial_pose.position_m = kStart;
  return config;
}

/** The palpation's probe over the nodule, pressing on without ever letting go. */
class Press
{
 public:
  explicit Press(const std::string& name) : scene_(loadScene(name))
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
  std::size_t tets() const { return scene_.tissues().at(0).rest.tets.size(); }

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
  state.counters["tets"] = static_cast<double>(press.tets());
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

void contactStep(benchmark::State& state, const std::string& scene)
{
  setThreadCount(static_cast<int>(state.range(0)));
  Press press(scene);
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

BENCHMARK_CAPTURE(contactStep, lobe_5k, "palpation.yaml")->Apply([](auto* bench) {
  measure(bench, 0.005);
});
BENCHMARK_CAPTURE(contactStep, lobe_20k, "palpation_20k.yaml")->Apply([](auto* bench) {
  measure(bench, 0.01);
});
}  // namespace
}  // namespace soft_tissue
