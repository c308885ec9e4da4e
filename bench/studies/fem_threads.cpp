#include "fem_threads.h"

#include <atomic>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

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
constexpr int kInTurn = 10;
/** Round trips longer than the one are between cores, than the other between such as share no
 * cache: on the machines seen they take 50, 110 and 530 ns. */
constexpr double kOneCoreNs = 80.0, kOneCacheNs = 250.0;

struct alignas(128) Flag
{
  std::atomic<int> value{0};
};

/** What a number takes from one thread to another and back, ns. */
double roundTripNs()
{
  constexpr int kTrips = 100, kTimes = 30;
  Flag there, back;
  std::atomic<bool> begun{false};
  std::thread other([&] {
    begun = true;
    for (int trip = 1; trip <= kTrips * kTimes; ++trip)
    {
      while (there.value.load(std::memory_order_acquire) != trip)
      {}
      back.value.store(trip, std::memory_order_release);
    }
  });
  while (!begun)
  {}
  std::vector<double> ns;
  for (int time = 0, trip = 0; time < kTimes; ++time)
  {
    const Timer timer;
    for (int k = 0; k < kTrips; ++k)
    {
      there.value.store(++trip, std::memory_order_release);
      while (back.value.load(std::memory_order_acquire) != trip)
      {}
    }
    ns.push_back(1e9 * timer.seconds() / kTrips);
  }
  other.join();
  return median(ns);
}

const char* placeOf(double before_ns, double after_ns)
{
  const auto name = [](double ns) {
    return ns < kOneCoreNs ? "one core" : ns < kOneCacheNs ? "one cache" : "apart";
  };
  return name(before_ns) == name(after_ns) ? name(before_ns) : "moved";
}

struct Case
{
  int thousands;
  MaterialModel law;
  const char* name;
  double gravity_m_per_s2;
  int steps;
};

/** Ratios and times with two threads, by where the cores were. */
struct Group
{
  std::vector<double> ratios, ms;
};

void race(const std::string& folder, const Case& which, std::ofstream& table)
{
  BeamSetup setup;
  setup.mesh = beamMesh(folder, which.thousands);
  setup.law = which.law;
  setup.gravity_m_per_s2 = which.gravity_m_per_s2;
  Scene one(beamScene(setup)), two(beamScene(setup));
  Scene* const scenes[] = {&one, &two};
  const std::size_t tets = one.tissues()[0].rest.tets.size();
  std::map<std::string, Group> groups;
  for (int step = 0; step < which.steps; step += kInTurn)
  {
    const double before_ns = roundTripNs();
    double ms[2];
    for (int k = 0; k < 2; ++k)
    {
      setThreadCount(k + 1);
      const Timer timer;
      for (int in_turn = 0; in_turn < kInTurn; ++in_turn)
      {
        scenes[k]->step();
      }
      ms[k] = 1e3 * timer.seconds() / kInTurn;
    }
    setThreadCount(1);
    const double after_ns = roundTripNs();
    const char* const place = placeOf(before_ns, after_ns);
    groups[place].ratios.push_back(ms[0] / ms[1]);
    groups[place].ms.push_back(ms[1]);
    char line[200];
    std::snprintf(line, sizeof(line), "%zu,%s,%g,%d,%s,%.3g,%.3g,%.4g,%.4g,%.3g\n", tets,
                  which.name, which.gravity_m_per_s2, step, place, before_ns, after_ns, ms[0],
                  ms[1], ms[0] / ms[1]);
    table << line << std::flush;
  }
  for (const auto& [place, group] : groups)
  {
    std::printf(
        "two threads: %zu tets, %s, gravity %g m/s^2, cores %s: %.2f times as fast "
        "(median of %zu), %.2f ms a step\n",
        tets, which.name, which.gravity_m_per_s2, place.c_str(), median(group.ratios),
        group.ratios.size(), median(group.ms));
  }
}
}  // namespace

void studyThreads(const std::string& folder, bool quick)
{
  if (std::thread::hardware_concurrency() < 2)
  {
    std::printf("two threads: there is one core only\n");
    return;
  }
  const std::string path = folder + "/fem_threads.csv";
  std::ofstream table(path);
  table << "tets,law,gravity_m_per_s2,step,cores,before_ns,after_ns,one_ms,two_ms,ratio\n";
  constexpr MaterialModel kNeo = MaterialModel::neo_hookean, kCorotated = MaterialModel::corotated;
  const std::vector<Case> cases =
      quick ? std::vector<Case>{{0, kNeo, "neo_hookean", 9.81, 20}}
            : std::vector<Case>{
                  {5, kNeo, "neo_hookean", 9.81, 300},      {5, kCorotated, "corotated", 9.81, 300},
                  {5, kNeo, "neo_hookean", 0.981, 300},     {20, kNeo, "neo_hookean", 9.81, 150},
                  {20, kCorotated, "corotated", 9.81, 150}, {20, kNeo, "neo_hookean", 0.981, 150}};
  for (const Case& which : cases)
  {
    race(folder, which, table);
  }
  if (!table)
  {
    throw Error(path + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
