#include "mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"

namespace soft_tissue
{
namespace
{
/** How far off the middle of an edge its node may be, in lengths of the edge: what single precision
 * and a few digits make of it. */
constexpr double kStraight = 1e-3;
}  // namespace

void MeshBuilder::addNode(double x, double y, double z)
{
  constexpr double kFarthest_m = 1.0e6;
  const Vec3 point = metres_per_unit_ * Vec3(x, y, z);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(std::abs(point[axis]) <= kFarthest_m))
    {
      cursor_->fail("node " + std::to_string(index_base_ + static_cast<long long>(nodes_.size())) +
                    " has coordinate " + "xyz"[axis] + " = " + decimal(point[axis]) +
                    " m, must be in [-1e6, 1e6] m");
    }
  }
  nodes_.push_back(point);
}

Index MeshBuilder::checkedNode(long long number) const
{
  const long long index = number - index_base_;
  if (index < 0 || index >= static_cast<long long>(nodes_.size()))
  {
    cursor_->fail("node " + std::to_string(number) + " does not exist, must be in [" +
                  std::to_string(index_base_) + ", " +
                  std::to_string(index_base_ + static_cast<long long>(nodes_.size()) - 1) + "]");
  }
  return static_cast<Index>(index);
}

void MeshBuilder::addTet(const std::array<long long, 4>& nodes, int tag)
{
  Tet tet;
  for (int i = 0; i < 4; ++i)
  {
    tet[i] = checkedNode(nodes[i]);
    if (std::find(tet.begin(), tet.begin() + i, tet[i]) != tet.begin() + i)
    {
      cursor_->fail("tet " + std::to_string(tets_.size() + 1) + " of the file has node " +
                    std::to_string(nodes[i]) + " twice");
    }
  }
  tets_.push_back(tet);
  tags_.push_back(tag);
}

void MeshBuilder::addQuadraticTet(const std::array<long long, 10>& nodes, int tag)
{
  addTet({nodes[0], nodes[1], nodes[2], nodes[3]}, tag);
  const Tet& tet = tets_.back();
  for (int edge = 0; edge < 6; ++edge)
  {
    const int* ends = kTetEdges[edge];
    const Index middle = checkedNode(nodes[4 + edge]);
    const Vec3 &a = nodes_[tet[ends[0]]], &b = nodes_[tet[ends[1]]];
    const double off = (nodes_[middle] - 0.5 * (a + b)).norm() / (b - a).norm();
    if (!(off <= kStraight))
    {
      cursor_->fail("quadratic tet " + std::to_string(tets_.size()) +
                    " of the file is curved: the node between its vertices " +
                    std::to_string(ends[0] + 1) + " and " + std::to_string(ends[1] + 1) + " is " +
                    decimal(off) + " edge lengths off the middle, must be in [0, " +
                    decimal(kStraight) +
                    "]; mesh with straight edges (Gmsh: " + "Mesh.SecondOrderLinear = 1)");
    }
    middles_.push_back(middle);
  }
}

/** Leaves vertices alone: quadratic elements have nodes of their own made from them. */
void MeshBuilder::dropMiddles()
{
  if (middles_.empty())
  {
    return;
  }
  const std::size_t quadratic = middles_.size() / 6;
  std::vector<char> dropped(nodes_.size(), 0);
  for (const Index node : middles_)
  {
    dropped[node] = 1;
  }
  std::vector<Index> number(nodes_.size(), 0);
  Points kept;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    number[i] = static_cast<Index>(kept.size());
    if (dropped[i] == 0)
    {
      kept.push_back(nodes_[i]);
    }
  }
  for (std::size_t t = 0; t < tets_.size(); ++t)
  {
    for (Index& node : tets_[t])
    {
      if (dropped[node] != 0)
      {
        throw Error(cursor_->path() + ": tet " + std::to_string(t + 1) +
                    " has for a vertex what is in the middle of a quadratic tet's edge; where both "
                    "meet they must share vertices");
      }
      node = number[node];
    }
  }
  nodes_ = std::move(kept);
  triangles_.clear();  // beside tets nobody asks for them
  warn(std::to_string(quadratic) +
       (quadratic == 1 ? " quadratic tet was" : " quadratic tets were") +
       " read by their vertices; element tet10 puts nodes in the middle of edges again");
}

void MeshBuilder::addPolygon(const std::vector<long long>& nodes)
{
  if (nodes.size() < 3)
  {
    cursor_->fail("a face has " + std::to_string(nodes.size()) + " nodes, must have 3 or more");
  }
  std::vector<Index> corners;
  for (const long long node : nodes)
  {
    corners.push_back(checkedNode(node));
  }
  for (std::size_t i = 2; i < corners.size(); ++i)
  {
    triangles_.push_back({corners[0], corners[i - 1], corners[i]});
  }
  ++polygons_;
}

void MeshBuilder::refuseVolumeElement(const std::string& kind) const
{
  cursor_->fail("holds a volume element that is no 4- or 10-node tetrahedron (" + kind +
                "); mesh with tetrahedra only");
}

void MeshBuilder::orientTets()
{
  for (Tet& tet : tets_)
  {
    if (signedVolume6(nodes_[tet[0]], nodes_[tet[1]], nodes_[tet[2]], nodes_[tet[3]]) < 0.0)
    {
      std::swap(tet[2], tet[3]);
      ++report_.reoriented_tets;
    }
  }
}

void MeshBuilder::warnOfOddities()
{
  std::vector<char> used(nodes_.size(), 0);
  for (const Tet& tet : tets_)
  {
    for (const Index node : tet)
    {
      used[node] = 1;
    }
  }
  for (const Triangle& triangle : triangles_)
  {
    for (const Index node : triangle)
    {
      used[node] = used[node] != 0 || tets_.empty() ? 1 : 0;
    }
  }
  const auto unused = std::count(used.begin(), used.end(), 0);
  if (unused > 0)
  {
    warn(std::to_string(unused) + (unused == 1 ? " node belongs" : " nodes belong") + " to no " +
         (tets_.empty() ? "triangle" : "tet"));
  }
  if (report_.reoriented_tets > 0)
  {
    warn(std::to_string(report_.reoriented_tets) + " left-handed tets were turned");
  }
}

LoadedMesh MeshBuilder::finish()
{
  if (nodes_.empty())
  {
    throw Error(cursor_->path() + ": is an empty mesh: it has no nodes");
  }
  if (tets_.empty() && triangles_.empty())
  {
    throw Error(cursor_->path() + ": is an empty mesh: it has " + std::to_string(nodes_.size()) +
                " nodes, but no tetrahedra and no triangles");
  }
  dropMiddles();
  orientTets();
  warnOfOddities();
  LoadedMesh loaded;
  report_.ignored_elements = others_ + (tets_.empty() ? 0 : polygons_);
  loaded.report = std::move(report_);
  if (tets_.empty())
  {
    loaded.surface = {std::move(nodes_), std::move(triangles_)};
  }
  else
  {
    loaded.volume = {std::move(nodes_), std::move(tets_), std::move(tags_)};
  }
  return loaded;
}

}  // namespace soft_tissue
