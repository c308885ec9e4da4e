#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "scene_impl.h"
#include "schema_sections.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** A third of the triangles around a node at rest, m^2. */
double areaOf(const TissueInfo& tissue, Index node)
{
  const Points& rest = tissue.rest.nodes;
  const Adjacency& around = tissue.surface.node_triangles;
  double area = 0.0;
  for (const Index* t = around.begin(node); t != around.end(node); ++t)
  {
    const Triangle& n = tissue.surface.triangles[*t];
    area += (rest[n[1]] - rest[n[0]]).cross(rest[n[2]] - rest[n[0]]).norm() / 6.0;
  }
  return area;
}

void check(const AttachRequest& request)
{
  if (!(request.reach_m >= 0.0) || !std::isfinite(request.reach_m))
  {
    throw Error("reach = " + shortest(request.reach_m) + " m, must be finite and >= 0");
  }
  const std::optional<double>& stiffness = request.stiffness_pa_per_m;
  if (stiffness && !kContactStiffness.holds(*stiffness))
  {
    throw Error("stiffness = " + shortest(*stiffness) + " Pa/m, must be " +
                kContactStiffness.text());
  }
}

/** A number that something has fewer of. */
void check(const char* what, std::optional<std::size_t> number, std::size_t count)
{
  if (number && *number >= count)
  {
    throw Error(std::string(what) + " " + std::to_string(*number) + " does not exist: there are " +
                std::to_string(count));
  }
}
}  // namespace

int Scene::Impl::attach(const AttachRequest& request)
{
  check("tool", request.tool, tools_.size());
  check("part", request.part, tools_[request.tool].parts.size());
  check("tissue", request.tissue, tissues_.size());
  check(request);
  const std::size_t before = attachments_.size();
  std::vector<char> chosen;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    chosen.push_back(request.tissue.value_or(k) == k ? 1 : 0);
  }
  wakeThose(chosen);  // what sleeps counts as fixed
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (chosen[k] != 0)
    {
      attachTissue(k, request);
    }
  }
  const auto order = [](const Attachment& a) { return std::tie(a.tool, a.part, a.row); };
  std::sort(attachments_.begin(), attachments_.end(),
            [&](const Attachment& a, const Attachment& b) { return order(a) < order(b); });
  const std::size_t count = attachments_.size() - before;
  if (count > 0)
  {
    noteAttachments();
  }
  return static_cast<int>(count);
}

/** Ties what of one body is near. */
void Scene::Impl::attachTissue(std::size_t tissue, const AttachRequest& request)
{
  const TissueInfo& info = tissue_info_[tissue];
  const std::vector<ToolPart>& parts = tools_[request.tool].parts;
  for (const Index node : info.surface.nodes)
  {
    Attachment one;
    one.tool = request.tool;
    one.tissue = tissue;
    one.row = tissues_[tissue].first_node + node;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
      const Vec3 p = parts[part].X_WP.inverse() * x_[one.row];
      const double distance = parts[part].shape.distance(p).distance;
      if (request.part.value_or(part) == part && distance < nearest)
      {
        nearest = distance;
        one.part = part;
        one.place_P = p;
      }
    }
    const bool tied =
        std::any_of(attachments_.begin(), attachments_.end(), [&](const Attachment& other) {
          return other.row == one.row && other.tool == one.tool && other.part == one.part;
        });
    if (nearest <= request.reach_m && !tied && !newton_->isFixed(one.row))
    {
      one.stiffness =
          areaOf(info, node) * request.stiffness_pa_per_m.value_or(stiffnessAgainstRigid(
                                   tissue, parts[one.part].shape.innerRadius()));
      attachments_.push_back(one);
    }
  }
}

int Scene::Impl::detach(std::size_t tool, std::optional<std::size_t> part)
{
  check("tool", tool, tools_.size());
  check("part", part, tools_[tool].parts.size());
  const auto goes = [&](const Attachment& one) {
    return one.tool == tool && part.value_or(one.part) == one.part;
  };
  const auto count = std::count_if(attachments_.begin(), attachments_.end(), goes);
  if (count > 0)
  {
    std::vector<char> tied(tissues_.size(), 0);
    for (const Attachment& one : attachments_)
    {
      tied[one.tissue] |= goes(one) ? 1 : 0;
    }
    wakeThose(tied);
    attachments_.erase(std::remove_if(attachments_.begin(), attachments_.end(), goes),
                       attachments_.end());
    noteAttachments();
  }
  return static_cast<int>(count);
}

/** Wakes those of the chosen tissues that sleep, and what sleeps with them. */
void Scene::Impl::wakeThose(const std::vector<char>& chosen)
{
  const std::size_t sleeping = sleepers();
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (asleep_[k] != 0 && chosen[k] != 0)
    {
      wake(island_[k]);
    }
  }
  if (sleepers() < sleeping)
  {
    setSleepers();
  }
}

/** What follows from others being tied: forces that steps must not carry on, and their count. */
void Scene::Impl::noteAttachments()
{
  forgetPast();
  newton_->forgetMatrix();
  countAttachments();
}

void Scene::Impl::countAttachments()
{
  for (Tool& tool : tools_)
  {
    tool.state.attached = 0;
    for (ToolPart& part : tool.parts)
    {
      part.attached = 0;
    }
  }
  for (const Attachment& one : attachments_)
  {
    ++tools_[one.tool].state.attached;
    ++tools_[one.tool].parts[one.part].attached;
  }
}

/** Springs draw nodes to where tools are after a share of the step. */
void Scene::Impl::beginAttachments(double to)
{
  std::vector<AnchorSpring>& springs = anchors_.springs();
  springs.clear();
  const ToolPart* last = nullptr;
  Pose X_WP = Pose::Identity();
  for (const Attachment& one : attachments_)
  {
    if (asleep_[one.tissue] != 0)
    {
      continue;
    }
    const ToolPart& part = tools_[one.tool].parts[one.part];
    if (&part != last)
    {
      X_WP = partAt(one.tool, part, to);
      last = &part;
    }
    springs.push_back({one.row, one.stiffness, X_WP * one.place_P});
  }
  if (!springs.empty())
  {
    terms_.push_back(&anchors_);
  }
}

/** Adds what ties tissue to tools to the contacts that make their wrenches. */
void Scene::Impl::collectAttachments()
{
  for (const Attachment& one : attachments_)
  {
    Tool& tool = tools_[one.tool];
    const AnchorSpring spring = {one.row, one.stiffness, tool.parts[one.part].X_WP * one.place_P};
    ContactPoint point;
    point.position_W = spring.place;
    point.force_W = spring.force(x_);
    const double force = point.force_W.norm();
    point.normal_W = force > 0.0 ? Vec3(point.force_W / force) : Vec3::UnitZ();
    point.tissue = static_cast<Index>(one.tissue);
    point.part = static_cast<Index>(one.part);
    tool.state.contacts.push_back(point);
  }
}

}  // namespace soft_tissue
