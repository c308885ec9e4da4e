#include "soft_tissue_sim/collision/box_selection.h"

namespace soft_tissue
{
namespace
{
std::uint8_t sidesBeyond(const Vec3& p, const Box3& box)
{
  std::uint8_t sides = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    sides |= static_cast<std::uint8_t>((p[axis] < box.min[axis]) << axis);
    sides |= static_cast<std::uint8_t>((p[axis] > box.max[axis]) << (axis + 3));
  }
  return sides;
}
}  // namespace

void BoxSelection::clear()
{
  tets_.clear();
  tet_nodes_.clear();
  surface_nodes_.clear();
  surface_edges_.clear();
}

void BoxSelection::select(const Points& x, const std::vector<Tet>& tets,
                          const BoundarySurface& surface, const Box3& box)
{
  clear();
  outside_.resize(x.size());
  wanted_.assign(x.size(), 0);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    outside_[i] = sidesBeyond(x[i], box);
  }
  // The box of an element misses `box` exactly when all its nodes are beyond one and the same side.
  for (std::size_t t = 0; t < tets.size(); ++t)
  {
    const Tet& tet = tets[t];
    if ((outside_[tet[0]] & outside_[tet[1]] & outside_[tet[2]] & outside_[tet[3]]) == 0)
    {
      tets_.push_back(static_cast<Index>(t));
      for (const Index node : tet)
      {
        wanted_[node] = 1;
      }
    }
  }
  for (std::size_t i = 0; i < x.size() && !tets_.empty(); ++i)
  {
    if (wanted_[i] != 0)
    {
      tet_nodes_.push_back(static_cast<Index>(i));
    }
  }
  for (const Index node : surface.nodes)
  {
    if (outside_[node] == 0)
    {
      surface_nodes_.push_back(node);
    }
  }
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    if ((outside_[surface.edges[e][0]] & outside_[surface.edges[e][1]]) == 0)
    {
      surface_edges_.push_back(static_cast<Index>(e));
    }
  }
}

}  // namespace soft_tissue
