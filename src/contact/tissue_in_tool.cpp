#include "tissue_in_tool.h"

#include <algorithm>
#include <cmath>

#include "moving_ends.h"
#include "quadrature.h"
#include "soft_tissue_sim/collision/inside_intervals.h"

namespace soft_tissue
{
namespace
{
Adjacency trianglesOfEdges(const BoundarySurface& surface)
{
  Adjacency rows;
  rows.offsets.assign(surface.edges.size() + 1, 0);
  for (const auto& edges : surface.triangle_edges)
  {
    for (const Index edge : edges)
    {
      ++rows.offsets[edge + 1];
    }
  }
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    rows.offsets[e + 1] += rows.offsets[e];
  }
  rows.items.resize(3 * surface.triangles.size());
  std::vector<Index> fill(rows.offsets.begin(), rows.offsets.end() - 1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    for (const Index edge : surface.triangle_edges[t])
    {
      rows.items[fill[edge]++] = static_cast<Index>(t);
    }
  }
  return rows;
}

/** A third of the area of all triangles in a row. */
double shareOfArea(const Points& x, const BoundarySurface& surface, const Adjacency& rows,
                   Index row)
{
  double share = 0.0;
  for (const Index* i = rows.begin(row); i != rows.end(row); ++i)
  {
    const Triangle& t = surface.triangles[*i];
    share += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm() / 6.0;
  }
  return share;
}
}  // namespace

TissueInTool::TissueInTool(const TissueBody& tissue, const RigidBodyShape& tool,
                           const ToolContactOptions& options)
    : tissue_(tissue),
      tool_(tool),
      options_(options),
      cell_length_(0.5 * tool.innerRadius()),
      edge_triangles_(trianglesOfEdges(*tissue.surface))
{}

void TissueInTool::place(const Pose& X_WT)
{
  X_WT_ = X_WT;
  X_TW_ = X_WT.inverse();
  bounds_W_ = transformed(X_WT, tool_.bounds());
}

void TissueInTool::lagAreas(const Points& x, const BoxSelection& elements)
{
  constexpr double kMostCells = 1000.0;
  const BoundarySurface& surface = *tissue_.surface;
  elements_.clear();
  if (options_.segments)
  {
    for (const Index e : elements.surfaceEdges())
    {
      const double length = (x[surface.edges[e][1]] - x[surface.edges[e][0]]).norm();
      const int cells = static_cast<int>(std::min(length / cell_length_, kMostCells)) + 1;
      elements_.push_back({e, shareOfArea(x, surface, edge_triangles_, e), cells});
    }
    return;
  }
  for (const Index node : elements.surfaceNodes())
  {
    elements_.push_back({node, shareOfArea(x, surface, surface.node_triangles, node), 0});
  }
}

void TissueInTool::addSamples(const Points& x, std::vector<ContactSample>& samples) const
{
  for (const Element& element : elements_)
  {
    if (options_.segments)
    {
      addEdge(element, x, samples);
    }
    else
    {
      addPoint(element, x, samples);
    }
  }
}

bool TissueInTool::measure(const Vec3& p, double area, ContactSample& sample) const
{
  const SignedDistance at = tool_.distance(X_TW_ * p);
  sample.position = p;
  sample.depth = -at.distance;
  sample.gradient = -(X_WT_.linear() * at.normal);
  sample.area = 0.5 * area;  // the two directions of the pair are averaged
  sample.stiffness_area = options_.stiffness_pa_per_m * sample.area;
  sample.force = sample.stiffness_area * sample.depth;
  sample.tool_sign = -1;
  return sample.depth > 0.0;
}

DepthCurvature TissueInTool::curvature(const ContactSample& sample) const
{
  const Mat3 R_WT = X_WT_.linear();
  DepthCurvature curvature;
  curvature.bend =
      -sample.depth * (R_WT * tool_.curvature(X_TW_ * sample.position) * R_WT.transpose());
  return curvature;
}

void TissueInTool::addPoint(const Element& node, const Points& x,
                            std::vector<ContactSample>& samples) const
{
  ContactSample sample;
  if (bounds_W_.contains(x[node.number]) && measure(x[node.number], node.area, sample))
  {
    sample.count = 1;
    sample.node[0] = tissue_.first_node + node.number;
    sample.coefficient[0] = 1.0;
    samples.push_back(sample);
  }
}

// Cells wholly inside the tool keep their quadrature points; in a cell that crosses the surface
// they move with it, and MovingEnds accounts for that.
void TissueInTool::addEdge(const Element& edge, const Points& x,
                           std::vector<ContactSample>& samples) const
{
  const Edge& nodes = tissue_.surface->edges[edge.number];
  const Vec3& a = x[nodes[0]];
  const Vec3 along = x[nodes[1]] - a;
  Box3 box;
  box.extend(a);
  box.extend(x[nodes[1]]);
  if (!box.overlaps(bounds_W_))
  {
    return;
  }
  const Vec3 along_T = X_TW_.linear() * along;
  const auto distance = [&](double parameter) {
    const SignedDistance at = tool_.distance(X_TW_ * Vec3(a + parameter * along));
    return SegmentDistance{at.distance, at.normal.dot(along_T)};
  };
  const auto sampleAt = [&](double parameter, double area, ContactSample& sample) {
    sample.count = 2;
    sample.node[0] = tissue_.first_node + nodes[0];
    sample.node[1] = tissue_.first_node + nodes[1];
    sample.coefficient[0] = 1.0 - parameter;
    sample.coefficient[1] = parameter;
    return measure(a + parameter * along, area, sample);
  };
  const auto addStretch = [&](const InsideInterval& inside) {
    MovingEnds ends(inside.where, along);
    forEachPoint(kGauss3, inside.where, [&](double parameter, double weight) {
      ContactSample sample;
      if (sampleAt(parameter, weight * edge.area, sample))
      {
        ends.count(sample, parameter);
        samples.push_back(sample);
      }
    });
    for (const bool at_begin : {true, false})
    {
      ContactSample sample;
      if (at_begin ? inside.begin_on_surface : inside.end_on_surface)
      {
        sampleAt(at_begin ? inside.where.begin : inside.where.end, edge.area, sample);
        if (ends.close(sample, at_begin))
        {
          samples.push_back(sample);
        }
      }
    }
  };
  forEachInsideInterval(distance, along.norm(), edge.cells, addStretch);
}

}  // namespace soft_tissue
