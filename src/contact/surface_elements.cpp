#include "surface_elements.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace soft_tissue
{
namespace
{
/** The triangles that have each of some parts, by the parts that each triangle has. */
Adjacency trianglesOf(std::size_t count, const std::vector<std::array<Index, 3>>& parts)
{
  Adjacency rows;
  rows.offsets.assign(count + 1, 0);
  for (const auto& three : parts)
  {
    for (const Index part : three)
    {
      ++rows.offsets[part + 1];
    }
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    rows.offsets[i + 1] += rows.offsets[i];
  }
  rows.items.resize(3 * parts.size());
  std::vector<Index> fill(rows.offsets.begin(), rows.offsets.end() - 1);
  for (std::size_t t = 0; t < parts.size(); ++t)
  {
    for (const Index part : parts[t])
    {
      rows.items[fill[part]++] = static_cast<Index>(t);
    }
  }
  return rows;
}

void addNode(Index row, double weight, ContactSample& sample, int first)
{
  int at = first;
  while (at < sample.count && sample.node[at] != row)
  {
    ++at;
  }
  if (at == sample.count)
  {
    sample.coefficient[at] = 0.0;
    sample.node[sample.count++] = row;
  }
  sample.coefficient[at] += weight;
}
}  // namespace

std::vector<Index> numbersOf(const std::vector<SurfaceElement>& elements, bool edges)
{
  std::vector<Index> numbers;
  for (const SurfaceElement& element : elements)
  {
    numbers.insert(numbers.end(), element.nodes.begin(), element.nodes.begin() + (edges ? 2 : 1));
  }
  return numbers;
}

ElementSet elementSet(const std::vector<Index>& numbers, bool edges)
{
  const int each = edges ? 2 : 1;
  return {numbers.data(), each, static_cast<Index>(numbers.size()) / each};
}

ElementSet tetsOf(const TissueBody& body)
{
  return {body.tets->data()->data(), 4, static_cast<Index>(body.tets->size())};
}

void addNodes(const TissueBody& body, const SurfaceElement& element, double parameter,
              ContactSample& sample)
{
  const int ends = element.nodes[0] == element.nodes[1] ? 1 : 2;
  const double weights[] = {1.0 - parameter, parameter};
  const int first = sample.count;
  for (int end = 0; end < ends; ++end)
  {
    if (body.points == nullptr)
    {
      sample.node[sample.count] = body.first_node + element.nodes[end];
      sample.coefficient[sample.count++] = weights[end];
      continue;
    }
    const SurfacePoints::Point& point = body.points->points[element.nodes[end]];
    for (int k = 0; k < 3; ++k)
    {
      if (point.weight[k] != 0.0)
      {
        addNode(body.first_node + point.node[k], weights[end] * point.weight[k], sample, first);
      }
    }
  }
}

int cellsOf(double length, double cell)
{
  constexpr double kMostCells = 1000.0;
  return cell > 0.0 ? static_cast<int>(std::min(length / cell, kMostCells)) + 1 : 1;
}

double perArea(ContactLaw law, const SurfaceElement& element, double length, double share)
{
  if (law == ContactLaw::pressure || !(element.area > 0.0))
  {
    return 1.0;
  }
  const bool is_edge = element.nodes[0] != element.nodes[1];
  const double whole = (is_edge ? length : 1.0) / (share * element.area);
  return law == ContactLaw::fisher2001 ? 2.0 * whole : whole;  // k d^2, not half of it
}

SurfaceElements::SurfaceElements(const BoundarySurface& surface, const ContactOptions& options,
                                 double share)
    : surface_(&surface), law_(options.law), share_(share)
{
  if (options.segments)
  {
    for (const Edge& edge : surface.edges)
    {
      elements_.push_back({{edge[0], edge[1]}});
    }
    triangles_ = trianglesOf(surface.edges.size(), surface.triangle_edges);
    return;
  }
  std::vector<std::array<Index, 3>> slots;
  for (const Triangle& t : surface.triangles)
  {
    slots.push_back({surface.node_slot[t[0]], surface.node_slot[t[1]], surface.node_slot[t[2]]});
  }
  for (const Index node : surface.nodes)
  {
    elements_.push_back({{node, node}});
  }
  triangles_ = trianglesOf(surface.nodes.size(), slots);
}

void SurfaceElements::lag(Index number, const Points& x, double cell)
{
  SurfaceElement& element = elements_[number];
  element.area = 0.0;
  for (const Index* i = triangles_.begin(number); i != triangles_.end(number); ++i)
  {
    const Triangle& t = surface_->triangles[*i];
    element.area += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm() / 6.0;
  }
  const double length = (x[element.nodes[1]] - x[element.nodes[0]]).norm();
  element.per_area = perArea(law_, element, length, share_);
  element.cells = cellsOf(length, cell);
}

}  // namespace soft_tissue
