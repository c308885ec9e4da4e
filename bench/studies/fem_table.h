#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue::studies
{
/** One way to compute a case. */
struct FemChoice
{
  ElementKind element = ElementKind::tet4;
  MaterialModel law = MaterialModel::neo_hookean;
  LinearSolverKind linear = LinearSolverKind::automatic;
  double tolerance = 1e-3;
};

/** What it took, and how far off it is. */
struct FemResult
{
  std::string other;  ///< what was used in place of a scene; empty: a scene
  std::size_t tets = 0, nodes = 0;
  double ms = 0.0;     ///< of the thread, a solve or a simulated second
  double found = 0.0;  ///< what errors are taken of: way, mm or as published
  double error = 0.0;  ///< relative
  bool converged = true;
};

/** DIR/fem.csv: speed against error, case by case. */
class FemTable
{
 public:
  /** @throws Error if the file can't be written */
  explicit FemTable(const std::string& folder);

  void add(const FemChoice& choice, const FemResult& result);

  /** Writes and prints what was added since the last case, and marks what no other way beats both
   * in time and in error, what none does with the same law on the same mesh, and the scene file's
   * defaults. @throws Error if it can't be written */
  void finishCase(const std::string& name);

 private:
  struct Row
  {
    FemChoice choice;
    FemResult result;
  };
  void check() const;

  std::string path_;
  std::ofstream stream_;
  std::vector<Row> rows_;
};

}  // namespace soft_tissue::studies
