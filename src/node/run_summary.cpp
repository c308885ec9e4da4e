#include "soft_tissue_sim/node/run_summary.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "contact_sums.h"
#include "soft_tissue_sim/node/json_writer.h"
#include "soft_tissue_sim/node/wrench_comparison.h"

namespace soft_tissue_sim
{
namespace
{
std::string hexadecimal(std::uint64_t value)
{
  char text[24];
  std::snprintf(text, sizeof(text), "%016" PRIx64, value);
  return text;
}

double nearestRank(std::vector<double> values, double fraction)
{
  if (values.empty())
  {
    return 0.0;
  }
  const double last = static_cast<double>(values.size() - 1);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::lround(fraction * last));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

void writeInput(const StreamCounts& input, JsonWriter& json)
{
  json.beginObject().value("of", input.of).value("topic", input.topic);
  json.value("messages", std::uint64_t{input.messages});
  json.value("used", std::uint64_t{input.used});
  json.value("out_of_order", std::uint64_t{input.out_of_order});
  json.value("beyond_limits", std::uint64_t{input.beyond_limits});
  json.beginArray("rejected");
  for (const auto& [reason, count] : input.rejected)
  {
    json.beginObject().value("reason", reason);
    json.value("messages", std::uint64_t{count}).endObject();
  }
  json.endArray().endObject();
}

}  // namespace

RunSummary::RunSummary(const soft_tissue::SceneConfig& config, const SceneInfo& info,
                       const BagPoses& bag)
    : scene_(config.file), time_step_s_(config.time_step_s)
{
  for (const soft_tissue::TissueInfo& tissue : info.tissues)
  {
    rest_.push_back(tissue.rest.nodes);
    bodies_.push_back({tissue.name, tissue.rest.nodes.size(), tissue.rest.tets.size(),
                       tissue.surface.triangles.size(), tissue.fixed_nodes.size()});
  }
  for (const soft_tissue::ToolInfo& tool : info.tools)
  {
    tools_.push_back({tool.name, {}, {}});
  }
  for (std::size_t tool = 0; tool < bag.tools.size(); ++tool)
  {
    tools_[tool].inputs = bag.tools[tool].counts;
  }
  for (const TissuePairInfo& pair : info.tissue_pairs)
  {
    pairs_.emplace_back();
    pairs_.back().first = info.tissue_names[pair.first];
    pairs_.back().second = info.tissue_names[pair.second];
    pairs_.back().name = pair.name;
  }
}

void RunSummary::add(const soft_tissue::Snapshot& snapshot)
{
  const soft_tissue::StepReport& report = snapshot.report;
  ++steps_;
  sim_time_s_ = report.time_s;
  not_converged_ += report.converged ? 0 : 1;
  held_ += report.held ? 1 : 0;
  halvings_ += static_cast<std::uint64_t>(report.halvings);
  newton_iterations_ += static_cast<std::uint64_t>(report.newton_iterations);
  linear_iterations_ += static_cast<std::uint64_t>(report.linear_iterations);
  min_det_f_ = std::min(min_det_f_, report.min_det_f);
  max_penetration_m_ = std::max(max_penetration_m_, report.max_penetration_m);
  max_residual_ = std::max(max_residual_, report.residual);
  state_hash_ = snapshot.state_hash;
  ms_sum_.fem += report.ms.fem;
  ms_sum_.field += report.ms.field;
  ms_sum_.detect += report.ms.detect;
  ms_sum_.respond += report.ms.respond;
  ms_sum_.solve += report.ms.solve;
  ms_sum_.total += report.ms.total;
  step_ms_.push_back(report.ms.total);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
  {
    const soft_tissue::Points& positions = snapshot.tissues[i].positions;
    for (std::size_t node = 0; node < positions.size(); ++node)
    {
      const double displacement = (positions[node] - rest_[i][node]).norm();
      finite_ = finite_ && std::isfinite(displacement);
      bodies_[i].max_displacement_m = std::max(bodies_[i].max_displacement_m, displacement);
    }
  }
  for (std::size_t i = 0; i < tools_.size(); ++i)
  {
    addTool(tools_[i], snapshot.tools[i], report.time_s);
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i)
  {
    addPair(pairs_[i], snapshot.tissue_pairs[i], report.time_s);
  }
}

void RunSummary::addTool(Tool& sum, const soft_tissue::ToolState& tool, double time_s)
{
  const double force = tool.wrench_W.force.norm();
  finite_ = finite_ && std::isfinite(force);
  sum.force.add(force, tool.contacts.size(), time_s);
}

void RunSummary::addPair(Pair& sum, const soft_tissue::TissuePairState& pair, double time_s)
{
  const ContactSums sums = sumOf(pair.contacts);
  sum.last_force_W = sums.force_W;
  sum.max_penetration_m = std::max(sum.max_penetration_m, sums.deepest_m);
  finite_ = finite_ && sums.force_W.allFinite();
  sum.force.add(sums.force_W.norm(), pair.contacts.size(), time_s);
}

void RunSummary::Force::add(double force_n, std::size_t contacts, double time_s)
{
  sum_n += force_n;
  most_contacts = std::max(most_contacts, contacts);
  if (force_n > peak_n)
  {
    peak_n = force_n;
    peak_time_s = time_s;
  }
}

std::string RunSummary::json(double wall_s, const WrenchComparison* comparison) const
{
  const double count = steps_ > 0 ? static_cast<double>(steps_) : 1.0;
  const double simulated = static_cast<double>(steps_) * time_step_s_;
  const auto write = [&](const Force& force, JsonWriter& to) {
    to.value("peak_force_n", force.peak_n).value("peak_force_time_s", force.peak_time_s);
    to.value("mean_force_n", force.sum_n / count);
    to.value("most_contacts", std::uint64_t{force.most_contacts});
  };
  JsonWriter json;
  json.beginObject();
  json.value("scene", scene_).value("time_step_s", time_step_s_).value("steps", steps_);
  json.value("sim_time_s", sim_time_s_).value("wall_s", wall_s);
  json.value("real_time_factor", wall_s > 0.0 ? simulated / wall_s : 0.0);
  json.value("finite", finite_).value("min_det_f", min_det_f_);
  json.value("max_penetration_m", max_penetration_m_).value("max_residual", max_residual_);
  json.value("newton_iterations_mean", static_cast<double>(newton_iterations_) / count);
  json.value("linear_iterations_mean", static_cast<double>(linear_iterations_) / count);
  json.value("steps_not_converged", not_converged_).value("steps_held", held_);
  json.value("step_halvings", halvings_).value("state_hash", hexadecimal(state_hash_));
  json.beginObject("stage_ms");
  json.value("fem", ms_sum_.fem / count).value("field", ms_sum_.field / count);
  json.value("detect", ms_sum_.detect / count).value("respond", ms_sum_.respond / count);
  json.value("solve", ms_sum_.solve / count);
  json.endObject().beginObject("step_ms");
  json.value("mean", ms_sum_.total / count).value("median", nearestRank(step_ms_, 0.5));
  json.value("p99", nearestRank(step_ms_, 0.99)).value("max", nearestRank(step_ms_, 1.0));
  json.endObject().beginArray("bodies");
  for (const Body& body : bodies_)
  {
    json.beginObject().value("name", body.name);
    json.value("nodes", std::uint64_t{body.nodes}).value("tets", std::uint64_t{body.tets});
    json.value("surface_triangles", std::uint64_t{body.triangles});
    json.value("fixed_nodes", std::uint64_t{body.fixed_nodes});
    json.value("max_displacement_m", body.max_displacement_m).endObject();
  }
  json.endArray().beginArray("tools");
  for (const Tool& tool : tools_)
  {
    json.beginObject().value("name", tool.name);
    write(tool.force, json);
    json.beginArray("inputs");
    for (const StreamCounts& input : tool.inputs)
    {
      writeInput(input, json);
    }
    json.endArray().endObject();
  }
  json.endArray().beginArray("tissue_pairs");
  for (const Pair& pair : pairs_)
  {
    json.beginObject().value("first", pair.first).value("second", pair.second);
    write(pair.force, json);
    json.value("max_penetration_m", pair.max_penetration_m);
    json.value("last_force_x_n", pair.last_force_W.x());
    json.value("last_force_y_n", pair.last_force_W.y());
    json.value("last_force_z_n", pair.last_force_W.z()).endObject();
  }
  json.endArray();
  if (comparison != nullptr)
  {
    comparison->write(json);
  }
  json.endObject();
  return json.text();
}

std::string RunSummary::text(double wall_s) const
{
  const double simulated = static_cast<double>(steps_) * time_step_s_;
  std::ostringstream text;
  text << steps_ << " steps, " << simulated << " s simulated in " << wall_s << " s ("
       << (wall_s > 0.0 ? simulated / wall_s : 0.0) << " times real time)\n"
       << "smallest det F " << min_det_f_ << ", deepest penetration " << 1.0e3 * max_penetration_m_
       << " mm, " << not_converged_ << " steps not converged, " << held_ << " held\n";
  for (const Tool& tool : tools_)
  {
    text << tool.name << ": peak force " << tool.force.peak_n << " N at " << tool.force.peak_time_s
         << " s\n";
  }
  for (const Pair& pair : pairs_)
  {
    text << pair.name << ": peak force " << pair.force.peak_n << " N at " << pair.force.peak_time_s
         << " s, deepest penetration " << 1.0e3 * pair.max_penetration_m << " mm\n";
  }
  text << "state hash " << hexadecimal(state_hash_) << "\n";
  return text.str();
}

}  // namespace soft_tissue_sim
