#include "stability_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "hard_cases.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue::studies
{
namespace
{
/** A quarter of each tet's mass on each of its nodes, kg. */
std::vector<double> nodalMasses(const TissueInfo& info, double density)
{
  std::vector<double> masses(info.rest.nodes.size(), 0.0);
  for (const Tet& tet : info.rest.tets)
  {
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
    {
      edges.col(k) = info.rest.nodes[tet[k + 1]] - info.rest.nodes[tet[0]];
    }
    for (const Index node : tet)
    {
      masses[node] += density * edges.determinant() / 24.0;
    }
  }
  return masses;
}

double kineticEnergy(const std::vector<double>& masses, const Points& velocities)
{
  double energy = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i)
  {
    energy += 0.5 * masses[i] * velocities[i].squaredNorm();
  }
  return energy;
}

bool allFinite(const TissueState& state)
{
  const auto finite = [](const Vec3& p) { return p.allFinite(); };
  return std::all_of(state.positions.begin(), state.positions.end(), finite) &&
         std::all_of(state.velocities.begin(), state.velocities.end(), finite);
}

template <typename Visit>
void forEachEdge(const TissueInfo& info, const Visit& visit)
{
  for (const Tet& tet : info.rest.tets)
  {
    for (int i = 0; i < 3; ++i)
    {
      for (int j = i + 1; j < 4; ++j)
      {
        visit(tet[i], tet[j]);
      }
    }
  }
}

/** What is left of its deformation, whichever way it is turned. */
void measureEdges(const TissueInfo& info, const TissueState& state, HardResult& result)
{
  forEachEdge(info, [&](Index i, Index j) {
    const Vec3 edge = state.positions[j] - state.positions[i];
    const double length = edge.norm();
    const double rest = (info.rest.nodes[j] - info.rest.nodes[i]).norm();
    result.strain_left = std::max(result.strain_left, std::abs(length / rest - 1.0));
    if (length > 0.0)
    {
      const double rate = edge.dot(state.velocities[j] - state.velocities[i]) / length;
      result.rate_left = std::max(result.rate_left, std::abs(rate));
    }
  });
}
}  // namespace

HardResult runHardCase(const HardCase& hard_case)
{
  HardResult result;
  const Timer timer;
  Scene scene(hard_case.config);
  if (hard_case.begin)
  {
    hard_case.begin(scene);
  }
  const TissueInfo& info = scene.tissues()[0];
  const std::vector<double> masses =
      nodalMasses(info, hard_case.config.tissues[0].material.density_kg_per_m3);
  result.tets = info.rest.tets.size();
  result.least_det_f = std::numeric_limits<double>::infinity();
  double peak[2] = {0.0, 0.0};
  Snapshot state;
  for (int step = 0; step < kHardSteps; ++step)
  {
    if (hard_case.before)
    {
      hard_case.before(scene, step);
    }
    const StepReport& report = scene.step();
    scene.fillSnapshot(state);
    const TissueState& tissue = state.tissues[0];
    result.finite = result.finite && allFinite(tissue);
    result.held += report.held ? 1 : 0;
    result.newton += static_cast<double>(report.newton_iterations) / kHardSteps;
    result.last_det_f = report.min_det_f;
    if (step >= kHardSteps / 5)
    {
      result.least_det_f = std::min(result.least_det_f, report.min_det_f);
    }
    double& most = peak[2 * step / kHardSteps];
    most = std::max(most, kineticEnergy(masses, tissue.velocities));
  }
  measureEdges(info, state.tissues[0], result);
  result.energy_growth = peak[0] > 0.0 ? peak[1] / peak[0] : 0.0;
  result.seconds = timer.seconds();
  return result;
}

void studyStability(const std::string& folder, bool quick)
{
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  const std::string path = folder + "/stability.csv";
  std::ofstream stream(path);
  stream << "case,tets,finite,least_det_f,last_det_f,strain_left,rate_left_m_per_s,energy_growth,"
            "held,should_end,ended_so,newton,seconds\n";
  std::printf("%-48s %6s %6s %9s %9s %8s %8s %5s %9s %6s\n", "case", "tets", "finite", "det F",
              "strain", "m/s", "energy", "held", "end", "Newton");
  const std::vector<HardCase> cases =
      hardCases(folder, data != nullptr ? std::string(data) + "/hard" : std::string());
  for (std::size_t i = 0; i < cases.size(); i += quick ? 16 : 1)
  {
    const HardCase& one = cases[i];
    const HardResult r = runHardCase(one);
    const char* const kEndings[] = {"back", "still", "any"};
    const char* const ending = kEndings[static_cast<int>(one.ending)];
    const bool ended = r.endedAs(one.ending);
    char line[300];
    std::snprintf(line, sizeof(line), "%zu,%d,%.4g,%.4g,%.3g,%.3g,%.3g,%d,%s,%d,%.3g,%.3g\n",
                  r.tets, r.finite ? 1 : 0, r.least_det_f, r.last_det_f, r.strain_left, r.rate_left,
                  r.energy_growth, r.held, ending, ended ? 1 : 0, r.newton, r.seconds);
    stream << '"' << one.name << "\"," << line << std::flush;
    std::printf("%-48s %6zu %6s %9.3g %9.2g %8.1e %8.2g %5d %9s %6.1f\n", one.name.c_str(), r.tets,
                r.finite ? "yes" : "NO", r.last_det_f, r.strain_left, r.rate_left, r.energy_growth,
                r.held, ended ? ending : "NO", r.newton);
    std::fflush(stdout);
  }
  if (!stream)
  {
    throw Error(path + ": can't be written");
  }
}
}  // namespace soft_tissue::studies
