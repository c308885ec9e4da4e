#include "marker_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Index;
using soft_tissue::Points;
using soft_tissue::Tet;
using soft_tissue::Triangle;
using soft_tissue::Vec3;

std_msgs::ColorRGBA colour(const Vec3& rgb)
{
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(rgb.x());
  message.g = static_cast<float>(rgb.y());
  message.b = static_cast<float>(rgb.z());
  message.a = 1.0F;
  return message;
}

std_msgs::ColorRGBA onScale(const std::array<Vec3, 3>& stops, double value)
{
  const double place = 2.0 * std::clamp(value, 0.0, 1.0);
  const std::size_t first = place < 1.0 ? 0 : 1;
  const double t = place - static_cast<double>(first);
  return colour((1.0 - t) * stops[first] + t * stops[first + 1]);
}

/** Where an edge between two nodes meets the slice, with the depth there. */
struct Cut
{
  Vec3 position;
  double depth;
};

}  // namespace

std_msgs::ColorRGBA rgb(double r, double g, double b, double opacity)
{
  std_msgs::ColorRGBA colour;
  colour.r = static_cast<float>(r);
  colour.g = static_cast<float>(g);
  colour.b = static_cast<float>(b);
  colour.a = static_cast<float>(opacity);
  return colour;
}

visualization_msgs::Marker makeMarker(const std::string& ns, int type)
{
  visualization_msgs::Marker marker;
  marker.ns = ns;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = colour(Vec3::Ones());
  return marker;
}

std_msgs::ColorRGBA tissueColour(double value)
{
  return onScale({Vec3(0.62, 0.22, 0.18), Vec3(0.95, 0.5, 0.2), Vec3(1.0, 0.95, 0.4)}, value);
}

std_msgs::ColorRGBA depthColour(double value)
{
  return onScale({Vec3(0.1, 0.1, 0.4), Vec3(0.1, 0.6, 0.5), Vec3(1.0, 0.95, 0.3)}, value);
}

std::vector<Vec3> nodeNormals(const Points& nodes, const std::vector<Triangle>& triangles)
{
  std::vector<Vec3> normals(nodes.size(), Vec3::Zero());
  for (const Triangle& t : triangles)
  {
    const Vec3 area = (nodes[t[1]] - nodes[t[0]]).cross(nodes[t[2]] - nodes[t[0]]);
    for (const Index node : t)
    {
      normals[node] += area;
    }
  }
  for (Vec3& normal : normals)
  {
    const double length = normal.norm();
    normal = length > 0.0 ? Vec3(normal / length) : Vec3::Zero();
  }
  return normals;
}

std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& colour, const Vec3& normal)
{
  static const Vec3 kToLight = Vec3(0.35, -0.45, 0.82).normalized();
  constexpr double kAmbient = 0.35;
  const double facing = 0.5 * (1.0 + normal.dot(kToLight));  // soft: the far side keeps its relief
  const auto brightness = static_cast<float>(kAmbient + (1.0 - kAmbient) * facing * facing);
  std_msgs::ColorRGBA shaded = colour;
  shaded.r *= brightness;
  shaded.g *= brightness;
  shaded.b *= brightness;
  return shaded;
}

void addCorner(visualization_msgs::Marker& marker, const Vec3& p, const std_msgs::ColorRGBA& colour)
{
  marker.points.push_back(pointMessage(p));
  marker.colors.push_back(colour);
}

void addSlice(visualization_msgs::Marker& marker, const Points& nodes, const std::vector<Tet>& tets,
              const std::vector<double>& depth, int axis, double offset, double depth_max)
{
  const auto cutEdge = [&](Index a, Index b) {
    const double ha = nodes[a][axis] - offset;
    const double hb = nodes[b][axis] - offset;
    const double t = ha / (ha - hb);
    return Cut{(1.0 - t) * nodes[a] + t * nodes[b], (1.0 - t) * depth[a] + t * depth[b]};
  };
  const auto addTriangle = [&](const Cut& a, const Cut& b, const Cut& c) {
    for (const Cut* cut : {&a, &b, &c})
    {
      addCorner(marker, cut->position, depthColour(cut->depth / depth_max));
    }
  };
  for (const Tet& tet : tets)
  {
    std::array<Index, 4> order = tet;
    const auto above = [&](Index node) { return nodes[node][axis] >= offset; };
    const auto middle = std::partition(order.begin(), order.end(), above);
    const auto count = middle - order.begin();
    const bool known =
        std::none_of(tet.begin(), tet.end(), [&](Index node) { return std::isnan(depth[node]); });
    if (count == 0 || count == 4 || !known)
    {
      continue;
    }
    if (count == 2)
    {
      const Cut a = cutEdge(order[0], order[2]);
      const Cut c = cutEdge(order[1], order[3]);
      addTriangle(a, cutEdge(order[0], order[3]), c);
      addTriangle(a, c, cutEdge(order[1], order[2]));
      continue;
    }
    const Index tip = count == 1 ? order[0] : order[3];
    const std::array<Index, 3> base = count == 1
                                          ? std::array<Index, 3>{order[1], order[2], order[3]}
                                          : std::array<Index, 3>{order[0], order[1], order[2]};
    addTriangle(cutEdge(tip, base[0]), cutEdge(tip, base[1]), cutEdge(tip, base[2]));
  }
}

}  // namespace soft_tissue_sim
