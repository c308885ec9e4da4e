#include "fem_race.h"

#include <algorithm>
#include <cstdio>
#include <deque>
#include <fstream>
#include <optional>

#include "plain_fem.h"
#include "sagging_beam.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/scene/scene.h"
#include "timing.h"

namespace soft_tissue::studies
{
namespace
{
constexpr int kMostLinearisations = 20;
constexpr double kConverged = 1e-8;

struct Way
{
  const char* name;
  bool plain;
  int threads;         ///< of the scene
  double tolerance;    ///< of Newton's method
  int linearisations;  ///< of the plain step, at most
};

/** One way's beam, and what its steps took. */
class Runner
{
 public:
  Runner(const Way& way, const BeamSetup& setup, const TetMesh& rest)
      : way_(way), rest_(rest), tip_(beamTip(rest.nodes)), residual_(rest, setup)
  {
    if (way.plain)
    {
      PlainFem::Options options;
      options.gravity = Vec3(0.0, -setup.gravity_m_per_s2, 0.0);
      options.linearisations = way.linearisations;
      options.tolerance = way.tolerance;
      const SceneConfig config = beamScene(setup);
      const MaterialConfig& material = config.tissues[0].material;
      plain_.emplace(rest, clampedNodes(rest.nodes),
                     TetStiffnessParameters{material.young_modulus_pa, material.poisson_ratio},
                     material.density_kg_per_m3, options);
      return;
    }
    BeamSetup own = setup;
    own.solver.tolerance = way.tolerance;
    own.solver.max_iterations = 200;
    scene_.emplace(beamScene(own));
    scene_->fillSnapshot(snapshot_);
  }

  void step(double step_s)
  {
    const Points x = positions(), v = velocities();
    setThreadCount(way_.threads);
    const Timer timer;
    const double busy = threadSeconds();
    if (plain_)
    {
      plain_->step();
    }
    else
    {
      scene_->step();
    }
    ms.push_back(1e3 * timer.seconds());
    thread_ms.push_back(1e3 * (threadSeconds() - busy));
    setThreadCount(1);
    if (scene_)
    {
      scene_->fillSnapshot(snapshot_);
    }
    const StepReport& report = snapshot_.report;
    newton += plain_ ? plain_->linearisations() : report.newton_iterations;
    linear += plain_ ? plain_->linearIterations() : report.linear_iterations;
    residuals.push_back(residual_.of(x, v, step_s, positions()));
    tips.push_back(meanWay(tip_, rest_.nodes, positions()));
  }

  const Way& way() const { return way_; }

  std::vector<double> ms, thread_ms, residuals;
  Points tips;  ///< m
  double newton = 0.0, linear = 0.0;

 private:
  const Points& positions() const
  {
    return plain_ ? plain_->positions() : snapshot_.tissues[0].positions;
  }
  const Points& velocities() const
  {
    return plain_ ? plain_->velocities() : snapshot_.tissues[0].velocities;
  }

  Way way_;
  const TetMesh& rest_;
  std::vector<Index> tip_;
  StepResidual residual_;
  std::optional<PlainFem> plain_;
  std::optional<Scene> scene_;
  Snapshot snapshot_;
};

double farthest(const Points& a, const Points& b)
{
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    most = std::max(most, (a[i] - b[i]).norm());
  }
  return most;
}

void race(const std::string& mesh, int steps, std::ofstream& table, std::ofstream& path)
{
  const Way ways[] = {{"scene", false, 1, 1e-3, 0},
                      {"scene", false, 2, 1e-3, 0},
                      {"scene 1e-2", false, 1, 1e-2, 0},
                      {"scene 1e-1", false, 1, 1e-1, 0},
                      {"plain", true, 1, 0.0, 1},
                      {"plain five", true, 1, 0.0, 5},
                      {"plain newton", true, 1, 1e-3, kMostLinearisations},
                      {"converged", false, 2, kConverged, 0}};
  BeamSetup setup;
  setup.mesh = mesh;
  const SceneConfig config = beamScene(setup);
  const TetMesh rest = Scene(config).tissues()[0].rest;
  std::deque<Runner> runners;  // none can be moved
  for (const Way& way : ways)
  {
    runners.emplace_back(way, setup, rest);
  }
  for (int k = 0; k < steps; ++k)
  {
    for (Runner& runner : runners)
    {
      runner.step(config.time_step_s);
    }
  }
  const Runner& first = runners.front();
  const Runner& converged = runners.back();
  for (const Runner& runner : runners)
  {
    const Way& way = runner.way();
    char line[300];
    std::snprintf(
        line, sizeof(line), "%zu,%zu,%s,%d,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.3g,%.3g,%.3g,%.4g,%.4g\n",
        rest.tets.size(), rest.nodes.size(), way.name, way.threads, steps, median(runner.ms),
        median(runner.thread_ms), mean(runner.thread_ms), runner.newton / steps,
        runner.linear / steps, median(runner.residuals),
        *std::max_element(runner.residuals.begin(), runner.residuals.end()),
        mean(runner.thread_ms) / mean(first.thread_ms), 1e3 * farthest(runner.tips, first.tips),
        1e3 * farthest(runner.tips, converged.tips));
    table << line << std::flush;
    std::printf("fem step: %s", line);
    for (int k = 0; k < steps; ++k)
    {
      std::snprintf(line, sizeof(line), "%zu,%s,%d,%d,%.6g,%.6g,%.3g\n", rest.tets.size(), way.name,
                    way.threads, k + 1, 1e3 * runner.tips[k].x(), 1e3 * runner.tips[k].y(),
                    runner.residuals[k]);
      path << line;
    }
  }
  std::fflush(stdout);
}
}  // namespace

void raceFem(const std::string& folder, bool quick)
{
  std::ofstream table(folder + "/fem_race.csv"), path(folder + "/fem_tip.csv");
  table << "tets,nodes,method,threads,steps,ms,thread_ms,mean_thread_ms,newton,linear,residual,"
           "worst_residual,"
           "mean_over_scene,"
           "tip_off_scene_mm,tip_off_converged_mm\n";
  path << "tets,method,threads,step,tip_x_mm,tip_y_mm,residual\n";
  if (quick)
  {
    race(beamMesh(folder, 0), 5, table, path);
  }
  else
  {
    race(beamMesh(folder, 5), 200, table, path);
    race(beamMesh(folder, 20), 30, table, path);
  }
  for (const std::ofstream* stream : {&table, &path})
  {
    if (!*stream)
    {
      throw Error(folder + "/" + (stream == &table ? "fem_race.csv" : "fem_tip.csv") +
                  ": can't be written");
    }
  }
}

}  // namespace soft_tissue::studies
