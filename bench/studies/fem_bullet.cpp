#include "fem_bullet.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>

#include "bullet_beam.h"
#include "sagging_beam.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/scene/scene.h"
#include "timing.h"

namespace soft_tissue::studies
{
namespace
{
/** What one engine's steps took, and where its tip went. */
struct Run
{
  const char* engine;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<BulletBeam> bullet;
  std::vector<double> ms;  ///< of the thread
  Points tips;             ///< m

  void step(double step_s, const Points& rest, const std::vector<Index>& tip)
  {
    const double start = threadSeconds();
    if (bullet != nullptr)
    {
      bullet->step(step_s);
    }
    else
    {
      scene->step();
    }
    ms.push_back(1e3 * (threadSeconds() - start));
    if (bullet != nullptr)
    {
      tips.push_back(meanWay(tip, rest, bullet->positions()));
      return;
    }
    Snapshot snapshot;
    scene->fillSnapshot(snapshot);
    tips.push_back(meanWay(tip, rest, snapshot.tissues[0].positions));
  }
};

std::unique_ptr<Scene> sceneOf(BeamSetup setup, double tolerance)
{
  setup.solver.tolerance = tolerance;
  setup.solver.max_iterations = 200;
  return std::make_unique<Scene>(beamScene(setup));
}

void race(const BeamSetup& setup, int steps, std::ofstream& table)
{
  const SceneConfig config = beamScene(setup);
  const bool neo_hookean = setup.law == MaterialModel::neo_hookean;
  std::vector<Run> runs;
  runs.push_back({"converged", sceneOf(setup, 1e-8), nullptr, {}, {}});
  runs.push_back({"scene", sceneOf(setup, config.solver.tolerance), nullptr, {}, {}});
  // Looser ones, as far as they go nearer than one linearisation a step does.
  runs.push_back({"scene 1e-2", sceneOf(setup, 1e-2), nullptr, {}, {}});
  runs.push_back({"scene 1e-1", sceneOf(setup, 1e-1), nullptr, {}, {}});
  const TetMesh& rest = runs[0].scene->tissues()[0].rest;
  if (BulletBeam::available())
  {
    const MaterialConfig& material = config.tissues[0].material;
    runs.push_back({"bullet",
                    nullptr,
                    std::make_unique<BulletBeam>(
                        rest, clampedNodes(rest.nodes), neo_hookean,
                        TetStiffnessParameters{material.young_modulus_pa, material.poisson_ratio},
                        material.density_kg_per_m3, config.gravity_m_per_s2),
                    {},
                    {}});
  }
  const std::vector<Index> tip = beamTip(rest.nodes);
  for (int k = 0; k < steps; ++k)
  {
    for (Run& run : runs)
    {
      run.step(config.time_step_s, rest.nodes, tip);
    }
  }
  for (const Run& run : runs)
  {
    double farthest = 0.0;
    for (int k = 0; k < steps; ++k)
    {
      farthest = std::max(farthest, 1e3 * (run.tips[k] - runs[0].tips[k]).norm());
    }
    const Vec3& end = run.tips.back();
    char line[300];
    std::snprintf(line, sizeof(line), "%zu,%s,%g,%s,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n",
                  rest.tets.size(), neo_hookean ? "neo_hookean" : "corotated",
                  setup.gravity_m_per_s2, run.engine, steps, median(run.ms), mean(run.ms),
                  1e3 * end.x(), 1e3 * end.y(), 1e3 * (end - runs[0].tips.back()).norm(), farthest);
    table << line << std::flush;
    std::printf("fem bullet: %s", line);
  }
  std::fflush(stdout);
}
}  // namespace

void raceBullet(const std::string& folder, bool quick)
{
  setThreadCount(1);
  const std::string path = folder + "/fem_bullet.csv";
  std::ofstream table(path);
  table << "tets,law,gravity,engine,steps,thread_ms,mean_ms,tip_x_mm,tip_y_mm,end_off_mm,farthest_"
           "off_mm\n";
  for (const int thousands : quick ? std::vector<int>{0} : std::vector<int>{1, 5})
  {
    for (const MaterialModel law : {MaterialModel::corotated, MaterialModel::neo_hookean})
    {
      for (const double gravity : {0.981, 9.81})
      {
        BeamSetup setup;
        setup.mesh = beamMesh(folder, thousands);
        setup.law = law;
        setup.gravity_m_per_s2 = gravity;
        race(setup, quick ? 5 : 200, table);
      }
    }
  }
  if (!table)
  {
    throw Error(path + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
