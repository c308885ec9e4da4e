#include "fem_table.h"

#include <algorithm>
#include <cstdio>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue::studies
{
namespace
{
/** Errors closer than this are the same: what is left is where iterations stopped. */
constexpr double kBetter = 1.001;

const char* nameOf(MaterialModel law)
{
  const char* const kNames[] = {"neo_hookean", "neo_hookean_log",     "exponential",
                                "corotated",   "st_venant_kirchhoff", "linear"};
  return kNames[static_cast<int>(law)];
}

const char* nameOf(ElementKind element)
{
  const char* const kNames[] = {"tet4", "tet4_anp", "tet10", "auto"};
  return kNames[static_cast<int>(element)];
}

const char* nameOf(LinearSolverKind linear)
{
  const char* const kNames[] = {"auto", "pcg", "cholesky"};
  return kNames[static_cast<int>(linear)];
}
}  // namespace

FemTable::FemTable(const std::string& folder) : path_(folder + "/fem.csv"), stream_(path_)
{
  stream_ << "case,method,element,law,linear,tolerance,tets,nodes,ms,found,error,converged,pareto,"
             "pareto_of_mesh,default\n";
  check();
}

void FemTable::add(const FemChoice& choice, const FemResult& result)
{
  rows_.push_back({choice, result});
}

void FemTable::finishCase(const std::string& name)
{
  for (const Row& row : rows_)
  {
    const FemChoice& choice = row.choice;
    const FemResult& result = row.result;
    const bool pareto = std::none_of(rows_.begin(), rows_.end(), [&](const Row& other) {
      return other.result.ms < result.ms && other.result.error < kBetter * result.error;
    });
    const bool pareto_of_mesh = std::none_of(rows_.begin(), rows_.end(), [&](const Row& other) {
      return other.choice.law == choice.law && other.result.tets == result.tets &&
             other.result.ms < result.ms && kBetter * other.result.error < result.error;
    });
    const TissueConfig tissue;
    const SolverConfig solver;
    const bool is_default = result.other.empty() && choice.element == tissue.element &&
                            choice.law == tissue.material.model && choice.linear == solver.linear &&
                            choice.tolerance == solver.tolerance;
    char line[300];
    std::snprintf(line, sizeof(line), "%s,%s,%s,%s,%s,%g,%zu,%zu,%.4g,%.6g,%.4g,%d,%d,%d,%d\n",
                  name.c_str(), result.other.empty() ? "scene" : result.other.c_str(),
                  nameOf(choice.element), nameOf(choice.law), nameOf(choice.linear),
                  choice.tolerance, result.tets, result.nodes, result.ms, result.found,
                  result.error, result.converged ? 1 : 0, pareto ? 1 : 0, pareto_of_mesh ? 1 : 0,
                  is_default ? 1 : 0);
    stream_ << line << std::flush;
    std::printf("fem %s", line);
  }
  std::fflush(stdout);
  rows_.clear();
  check();
}

void FemTable::check() const
{
  if (!stream_)
  {
    throw Error(path_ + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
