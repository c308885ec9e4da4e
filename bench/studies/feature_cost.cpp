#include "feature_cost.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

#include "feature_scenes.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/timer.h"
#include "timing.h"

namespace soft_tissue::studies
{
namespace
{
/** A scene, and what its steps took. */
struct Run
{
  explicit Run(const FeatureVariant& of) : variant(of), scene(of.config) {}

  const FeatureVariant& variant;
  Scene scene;
  Snapshot snapshot;
  std::vector<double> thread_ms, wall_ms;
  double newton = 0.0, linear = 0.0, contacts = 0.0;
  int held = 0;

  void step(bool counts)
  {
    setThreadCount(variant.threads);
    const Timer wall;
    const double begin = threadSeconds();
    const StepReport& report = scene.step();
    if (variant.reads_out)
    {
      scene.fillSnapshot(snapshot);
    }
    if (counts)
    {
      thread_ms.push_back(1e3 * (threadSeconds() - begin));
      wall_ms.push_back(1e3 * wall.seconds());
      newton += report.newton_iterations;
      linear += report.linear_iterations;
      contacts += report.contacts;
      held += report.held ? 1 : 0;
    }
  }
};

/** Median of how many times as long each step took. */
double ratioOf(const std::vector<double>& times, const std::vector<double>& others)
{
  std::vector<double> ratios;
  for (std::size_t k = 0; k < times.size(); ++k)
  {
    ratios.push_back(times[k] / others[k]);
  }
  return median(ratios);
}

/** Steps all states of a feature in turn. */
void measure(const Feature& feature, int prepared, int steps, std::ofstream& stream)
{
  std::vector<std::unique_ptr<Run>> runs;
  for (const FeatureVariant& variant : feature.variants)
  {
    runs.push_back(std::make_unique<Run>(variant));
  }
  for (int step = -prepared; step < steps; ++step)
  {
    // Whoever comes second finds caches as the first one left them: each does in turn.
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
      runs[(k + step + prepared) % runs.size()]->step(step >= 0);
    }
  }
  for (const std::unique_ptr<Run>& run : runs)
  {
    const Run& off = *runs[0];
    char line[300];
    std::snprintf(line, sizeof(line), "%s,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%d\n",
                  run->variant.state.c_str(), run->variant.threads, median(run->thread_ms),
                  ratioOf(run->thread_ms, off.thread_ms), median(run->wall_ms),
                  ratioOf(run->wall_ms, off.wall_ms), run->newton / steps, run->linear / steps,
                  run->contacts / steps, run->held);
    stream << '"' << feature.name << "\"," << line << std::flush;
    std::printf("%-36s %s", feature.name.c_str(), line);
    std::fflush(stdout);
  }
}
}  // namespace

void studyFeatures(const std::string& folder, bool quick)
{
  const std::string path = folder + "/features.csv";
  std::ofstream stream(path);
  stream << "feature,state,threads,ms,ratio,wall_ms,wall_ratio,newton,linear,contacts,held\n";
  if (!stream)
  {
    throw Error(path + ": can't be written");
  }
  for (const Feature& feature : featureScenes(folder, quick ? 2 : 6))
  {
    measure(feature, quick ? 10 : 40, quick ? 6 : 101, stream);
  }
  setThreadCount(1);
  if (!stream)
  {
    throw Error(path + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
