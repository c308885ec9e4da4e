#pragma once

#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "field_bodies.h"

namespace soft_tissue::studies
{
/** Median of some values, at least one. */
double median(std::vector<double> values);

/** Median wall time of several calls, ms. */
double timed(int repeats, const std::function<void()>& call);

/** field.csv, a line a measurement, each shown as well. */
class Table
{
 public:
  /** What was measured, and how. */
  struct Method
  {
    std::string name;
    int order = 0;       ///< of a grid's scheme
    int resolution = 0;  ///< points of a grid along its longest axis
  };

  /** @throws Error if the file can't be written */
  explicit Table(const std::string& folder);

  /** @param depths  of all nodes; errors are taken over those inside */
  void add(const FieldBody& body, const Method& method, double ms,
           const std::vector<double>& depths, const std::vector<double>& truth,
           std::uint64_t evaluations);

 private:
  void check() const;

  std::string path_;
  std::ofstream stream_;
};

}  // namespace soft_tissue::studies
