#include "soft_tissue_sim/node/wrench_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
using soft_tissue::Vec3;
using soft_tissue::Wrench;

WrenchErrors errorsOf(const std::vector<WrenchPair>& pairs)
{
  WrenchErrors errors;
  errors.samples = pairs.size();
  double measured = 0.0, simulated = 0.0, both = 0.0, error = 0.0, moment = 0.0, moment_error = 0.0;
  for (const WrenchPair& pair : pairs)
  {
    const Vec3 difference = pair.simulated_W.force - pair.measured_W.force;
    measured += pair.measured_W.force.squaredNorm();
    simulated += pair.simulated_W.force.squaredNorm();
    both += pair.measured_W.force.dot(pair.simulated_W.force);
    error += difference.squaredNorm();
    moment += pair.measured_W.torque.squaredNorm();
    moment_error += (pair.simulated_W.torque - pair.measured_W.torque).squaredNorm();
    errors.mean_error_n += difference;
    errors.measured_peak_n = std::max(errors.measured_peak_n, pair.measured_W.force.norm());
    errors.simulated_peak_n = std::max(errors.simulated_peak_n, pair.simulated_W.force.norm());
    if (difference.norm() > errors.greatest_error_n)
    {
      errors.greatest_error_n = difference.norm();
      errors.greatest_error_time_s = pair.time_s;
    }
  }
  const double n = std::max<double>(1.0, static_cast<double>(pairs.size()));
  errors.measured_n = std::sqrt(measured / n);
  errors.error_n = std::sqrt(error / n);
  errors.measured_nm = std::sqrt(moment / n);
  errors.error_nm = std::sqrt(moment_error / n);
  errors.mean_error_n /= n;
  errors.likeness =
      measured > 0.0 && simulated > 0.0 ? both / std::sqrt(measured * simulated) : 0.0;
  return errors;
}

WrenchComparison::WrenchComparison(std::vector<std::string> tools,
                                   std::vector<WrenchSeries> measured)
    : tools_(std::move(tools)), measured_(std::move(measured)), pairs_(measured_.size())
{
  const auto isEmpty = [](const WrenchSeries& series) { return series.empty(); };
  if (std::all_of(measured_.begin(), measured_.end(), isEmpty))
  {
    std::string names;
    for (const std::string& tool : tools_)
    {
      names += (names.empty() ? "" : ", ") + tool + "/body/measured_cf or " + tool +
               "/spatial/measured_cf";
    }
    throw soft_tissue::Error("the bag has no usable force to compare with; looked for " + names);
  }
}

void WrenchComparison::add(const soft_tissue::Snapshot& snapshot)
{
  const double time = snapshot.report.time_s;
  for (std::size_t tool = 0; tool < measured_.size(); ++tool)
  {
    if (std::optional<Wrench> measured = measured_[tool].at(time))
    {
      const soft_tissue::ToolState& state = snapshot.tools[tool];
      if (measured_[tool].in_tool_axes)
      {
        measured->force = state.X_WT.linear() * measured->force;
        measured->torque = state.X_WT.linear() * measured->torque;
      }
      pairs_[tool].push_back({time, *measured, state.wrench_W});
    }
  }
}

void WrenchComparison::write(JsonWriter& json) const
{
  json.beginArray("comparison");
  for (std::size_t tool = 0; tool < measured_.size(); ++tool)
  {
    if (measured_[tool].empty())
    {
      continue;
    }
    const WrenchErrors errors = errorsOf(pairs_[tool]);
    json.beginObject().value("tool", tools_[tool]).value("topic", measured_[tool].topic);
    json.value("samples", std::uint64_t{errors.samples});
    json.value("measured_rms_n", errors.measured_n).value("error_rms_n", errors.error_n);
    json.value("relative_error", errors.error_n / errors.measured_n);
    json.value("greatest_error_n", errors.greatest_error_n);
    json.value("greatest_error_time_s", errors.greatest_error_time_s);
    json.value("mean_error_x_n", errors.mean_error_n.x());
    json.value("mean_error_y_n", errors.mean_error_n.y());
    json.value("mean_error_z_n", errors.mean_error_n.z());
    json.value("measured_peak_n", errors.measured_peak_n);
    json.value("simulated_peak_n", errors.simulated_peak_n);
    json.value("measured_rms_nm", errors.measured_nm).value("error_rms_nm", errors.error_nm);
    json.value("likeness", errors.likeness).endObject();
  }
  json.endArray();
}

std::string WrenchComparison::text() const
{
  constexpr double kReversed = -0.5;
  std::ostringstream text;
  for (std::size_t tool = 0; tool < measured_.size(); ++tool)
  {
    if (measured_[tool].empty())
    {
      continue;
    }
    const WrenchErrors errors = errorsOf(pairs_[tool]);
    text << tools_[tool] << " against " << measured_[tool].topic << ": " << errors.samples
         << " samples, measured " << errors.measured_n << " N rms, error " << errors.error_n
         << " N rms (" << 100.0 * errors.error_n / errors.measured_n << " %), at most "
         << errors.greatest_error_n << " N at " << errors.greatest_error_time_s << " s; peak "
         << errors.measured_peak_n << " N measured, " << errors.simulated_peak_n
         << " N simulated\n";
    if (errors.likeness < kReversed)
    {
      text << "  the forces point against each other: is what was measured the force on the "
              "tissue?\n";
    }
  }
  return text.str();
}

void WrenchComparison::writeCsv(const std::string& path) const
{
  std::ofstream stream(path);
  stream.precision(17);
  stream << "tool,time_s";
  for (const char* of : {"measured", "simulated"})
  {
    for (const char* column :
         {"force_x_n", "force_y_n", "force_z_n", "torque_x_nm", "torque_y_nm", "torque_z_nm"})
    {
      stream << ',' << of << '_' << column;
    }
  }
  stream << '\n';
  for (std::size_t tool = 0; tool < pairs_.size(); ++tool)
  {
    for (const WrenchPair& pair : pairs_[tool])
    {
      stream << tools_[tool] << ',' << pair.time_s;
      for (const Wrench* wrench : {&pair.measured_W, &pair.simulated_W})
      {
        for (const Vec3* v : {&wrench->force, &wrench->torque})
        {
          stream << ',' << v->x() << ',' << v->y() << ',' << v->z();
        }
      }
      stream << '\n';
    }
  }
  stream.close();
  if (!stream)
  {
    throw soft_tissue::Error("csv " + path + ": can't be written");
  }
}

WrenchComparison readComparison(const RunOptions& options, const Replay& replay)
{
  std::vector<std::string> names, warnings;
  for (const soft_tissue::ToolConfig& tool : replay.config.tools)
  {
    names.push_back(tool.name);
  }
  std::vector<WrenchSeries> measured = readBagWrenches(
      options.bag_in, replay.config.tools, options.world_frame, replay.poses.start, warnings);
  for (const std::string& warning : warnings)
  {
    std::fprintf(stderr, "warning: bag %s: %s\n", options.bag_in.c_str(), warning.c_str());
  }
  for (WrenchSeries& series : measured)
  {
    if (options.tare_s && !series.empty())
    {
      series.tare(*options.tare_s);
    }
  }
  return WrenchComparison(names, measured);
}

}  // namespace soft_tissue_sim
