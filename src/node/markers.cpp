#include "soft_tissue_sim/node/markers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "marker_shapes.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::ContactPoint;
using soft_tissue::Index;
using soft_tissue::Snapshot;
using soft_tissue::TissueInfo;
using soft_tissue::ToolState;
using soft_tissue::Vec3;
using visualization_msgs::Marker;

constexpr double kFixedNodeSize = 0.002;               // m
constexpr double kFieldNodeSize = 0.0012;              // m
constexpr double kLongestContact = 0.015;              // m
constexpr double kSmallestDisplacementScale = 1.0e-3;  // m: an idle tissue is not painted by noise

Marker tissueSurface(const TissueInfo& info, const soft_tissue::TissueState& state,
                     const MarkerOptions& options)
{
  const auto& triangles = info.surface.triangles;
  const bool by_stress =
      options.colour_by == MarkerOptions::ColourBy::stress && !state.von_mises.empty();
  const auto value = [&](std::size_t triangle, Index node) {
    return by_stress ? static_cast<double>(state.von_mises[info.surface.triangle_tet[triangle]])
                     : (state.positions[node] - info.rest.nodes[node]).norm();
  };
  double largest = options.colour_max;
  if (largest == 0.0)
  {
    largest = by_stress ? 1.0 : kSmallestDisplacementScale;
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (const Index node : triangles[t])
      {
        largest = std::max(largest, value(t, node));
      }
    }
  }
  const std::vector<Vec3> normals = nodeNormals(state.positions, triangles);
  Marker marker = makeMarker(info.name, Marker::TRIANGLE_LIST);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (const Index node : triangles[t])
    {
      addCorner(marker, state.positions[node],
                lit(tissueColour(value(t, node) / largest), normals[node]));
    }
  }
  return marker;
}

Marker fixedNodes(const TissueInfo& info, const soft_tissue::TissueState& state)
{
  Marker marker = makeMarker(info.name + "/fixed", Marker::SPHERE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = kFixedNodeSize;
  marker.color = rgb(0.3, 0.5, 0.9);
  for (const Index node : info.fixed_nodes)
  {
    marker.points.push_back(pointMessage(state.positions[node]));
  }
  return marker;
}

double deepest(const std::vector<double>& depth)
{
  double largest = 1.0e-6;
  for (const double d : depth)
  {
    largest = d > largest ? d : largest;  // false for NaN
  }
  return largest;
}

Marker fieldNodes(const TissueInfo& info, const soft_tissue::TissueState& state,
                  const std::vector<double>& depth)
{
  Marker marker = makeMarker(info.name + "/distance/nodes", Marker::POINTS);
  marker.scale.x = marker.scale.y = kFieldNodeSize;
  const double depth_max = deepest(depth);
  for (std::size_t node = 0; node < depth.size(); ++node)
  {
    if (!std::isnan(depth[node]))
    {
      addCorner(marker, state.positions[node], depthColour(depth[node] / depth_max));
    }
  }
  return marker;
}

Marker arrow(const std::string& ns, const Vec3& from, const Vec3& to, double thickness)
{
  Marker marker = makeMarker(ns, Marker::ARROW);
  marker.scale.x = thickness;
  marker.scale.y = 2.0 * thickness;
  marker.scale.z = 0.0;  // head length: rviz chooses
  marker.points = {pointMessage(from), pointMessage(to)};
  return marker;
}

/** Arrows at the strongest contacts, the strongest of them kLongestContact long; unused ids, of
 * those from `first_id` on, deleted. */
void addContactArrows(const std::string& ns, std::size_t first_id,
                      const std::vector<ContactPoint>& contacts, std::vector<Marker>& markers)
{
  std::vector<std::size_t> order(contacts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto force = [&](std::size_t i) { return contacts[i].force_W.norm(); };
  const std::size_t shown = std::min(order.size(), kMaxContactArrows);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return force(a) != force(b) ? force(a) > force(b) : a < b;
                    });
  const double largest = shown > 0 ? force(order[0]) : 0.0;
  for (std::size_t i = 0; i < kMaxContactArrows; ++i)
  {
    if (i < shown && largest > 0.0)
    {
      const ContactPoint& contact = contacts[order[i]];
      const Vec3 tip = contact.position_W + kLongestContact / largest * contact.force_W;
      markers.push_back(arrow(ns, contact.position_W, tip, 4.0e-4));
      markers.back().color = rgb(0.2, 0.9, 0.3);
    }
    else
    {
      markers.push_back(makeMarker(ns, Marker::ARROW));
      markers.back().action = Marker::DELETE;
    }
    markers.back().id = static_cast<int>(first_id + i);
  }
}

/** Whether it is drawn from its points. */
bool isList(const Marker& marker)
{
  return marker.type == Marker::TRIANGLE_LIST ||
         (marker.type >= Marker::LINE_STRIP && marker.type <= Marker::POINTS);
}

Marker forceArrow(const std::string& ns, const ToolState& tool, double metres_per_newton)
{
  const Vec3 from = tool.X_WT.translation();
  Marker marker = arrow(ns, from, from + metres_per_newton * tool.wrench_W.force, 1.0e-3);
  marker.color = rgb(0.95, 0.9, 0.2);
  if (tool.wrench_W.force.isZero(0.0))
  {
    marker.action = Marker::DELETE;
  }
  return marker;
}

}  // namespace

MarkerBuilder::MarkerBuilder(const SceneInfo& info, const MarkerOptions& options)
    : info_(info), options_(options)
{
  for (const TissueInfo& tissue : info.tissues)
  {
    double low = tissue.rest.nodes.front()[options.slice_axis];
    double high = low;
    for (const Vec3& node : tissue.rest.nodes)
    {
      low = std::min(low, node[options.slice_axis]);
      high = std::max(high, node[options.slice_axis]);
    }
    slice_offset_m_.push_back(low + options.slice_fraction * (high - low));
  }
  for (std::size_t i = 0; i < info.tools.size(); ++i)
  {
    tools_.push_back(toolLooks(info.tools[i], info.tool_configs[i]));
  }
}

visualization_msgs::MarkerArray MarkerBuilder::build(const Snapshot& snapshot, TissueDepths& depths,
                                                     const Stamp& stamp) const
{
  visualization_msgs::MarkerArray array;
  for (std::size_t i = 0; i < info_.tissues.size(); ++i)
  {
    const TissueInfo& info = info_.tissues[i];
    const soft_tissue::TissueState& state = snapshot.tissues[i];
    array.markers.push_back(tissueSurface(info, state, options_));
    array.markers.push_back(fixedNodes(info, state));
    if (depths.has(i))
    {
      const std::vector<double>& depth = depths.depth(i, snapshot);
      array.markers.push_back(fieldNodes(info, state, depth));
      Marker slice = makeMarker(info.name + "/distance/slice", Marker::TRIANGLE_LIST);
      addSlice(slice, state.positions, info.rest.tets, depth, options_.slice_axis,
               slice_offset_m_[i], deepest(depth));
      array.markers.push_back(slice);
    }
  }
  for (std::size_t i = 0; i < info_.tools.size(); ++i)
  {
    const ToolState& tool = snapshot.tools[i];
    const soft_tissue::ToolConfig& config = info_.tool_configs[i];
    for (const ToolLook& look : tools_[i])
    {
      const soft_tissue::Pose X_TL = config.linkage.pose(config.frame, look.link, tool.joints);
      array.markers.push_back(look.marker);
      array.markers.back().pose = poseMessage(tool.X_WT * X_TL * look.X_LM);
    }
    addContactArrows(info_.tools[i].name + "/contacts", 0, tool.contacts, array.markers);
    array.markers.push_back(
        forceArrow(info_.tools[i].name + "/force", tool, options_.force_scale_m_per_n));
  }
  for (std::size_t i = 0; i < snapshot.tissue_pairs.size(); ++i)
  {
    addContactArrows("tissue_pairs", i * kMaxContactArrows, snapshot.tissue_pairs[i].contacts,
                     array.markers);
  }
  for (Marker& marker : array.markers)
  {
    marker.header.frame_id = stamp.world_frame;
    marker.header.stamp = stamp.time;
    if (isList(marker) && marker.points.empty())
    {
      marker.action = Marker::DELETE;  // rviz complains of empty lists
    }
  }
  return array;
}

Marker MarkerBuilder::deleteAll(const Stamp& stamp)
{
  Marker marker;
  marker.header.frame_id = stamp.world_frame;
  marker.header.stamp = stamp.time;
  marker.action = Marker::DELETEALL;
  return marker;
}

}  // namespace soft_tissue_sim
