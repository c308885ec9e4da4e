#include "field_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue::studies
{
double median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double timed(int repeats, const std::function<void()>& call)
{
  std::vector<double> ms;
  for (int k = 0; k < repeats; ++k)
  {
    const Timer timer;
    call();
    ms.push_back(1e3 * timer.seconds());
  }
  return median(ms);
}

Table::Table(const std::string& folder) : path_(folder + "/field.csv"), stream_(path_)
{
  stream_ << "case,dim,elements,nodes,method,order,resolution,ms,max_err,median_err,"
             "wrong_fraction,evaluations\n";
  check();
}

void Table::add(const FieldBody& body, const Method& method, double ms,
                const std::vector<double>& depths, const std::vector<double>& truth,
                std::uint64_t evaluations)
{
  std::vector<double> errors;
  double wrong = 0.0, deepest = 0.0;
  for (std::size_t node = 0; node < depths.size(); ++node)
  {
    deepest = std::max(deepest, truth[node]);
  }
  for (std::size_t node = 0; node < depths.size(); ++node)
  {
    if (body.surface.node_slot[node] < 0 && std::isfinite(depths[node]))
    {
      errors.push_back(std::abs(depths[node] - truth[node]));
      wrong += errors.back() > 1e-12 * deepest ? 1.0 : 0.0;
    }
  }
  const double largest = errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end());
  const double middle = errors.empty() ? 0.0 : median(errors);
  const double share = errors.empty() ? 0.0 : wrong / static_cast<double>(errors.size());
  const auto shown = [](int number) { return number > 0 ? std::to_string(number) : ""; };
  char line[400];
  std::snprintf(line, sizeof(line), "%s,%d,%zu,%zu,%s,%s,%s,%.4g,%.4g,%.4g,%.4g,%llu\n",
                body.name.c_str(), body.dimension, body.elements, body.x.size(),
                method.name.c_str(), shown(method.order).c_str(), shown(method.resolution).c_str(),
                ms, largest, middle, share, static_cast<unsigned long long>(evaluations));
  stream_ << line << std::flush;
  check();
  std::printf("%-20s %8zu %-27s %1s %4s %10.3f ms  max %.2e  median %.2e  wrong %6.2f %%\n",
              body.name.c_str(), body.elements, method.name.c_str(), shown(method.order).c_str(),
              shown(method.resolution).c_str(), ms, largest, middle, 100.0 * share);
  std::fflush(stdout);
}

void Table::check() const
{
  if (!stream_)
  {
    throw Error(path_ + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
