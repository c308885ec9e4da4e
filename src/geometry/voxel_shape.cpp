#include "soft_tissue_sim/geometry/voxel_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "signed_surface.h"
#include "surface_grid.h"
#include "voxel_net.h"

namespace soft_tissue
{
namespace
{
constexpr int kPatch = 16;  ///< cells along each edge of a patch

/** A ball about the surface that has lost its direction, in the size of a patch. */
constexpr double kOnSurface = 1e-12;

bool before(const Cell& a, const Cell& b)
{
  return std::tie(a.z(), a.y(), a.x()) < std::tie(b.z(), b.y(), b.x());
}

CellBox cellsOf(const Cell& patch)
{
  return {patch * kPatch, (patch + Cell::Ones()) * kPatch};
}

CellBox grown(const CellBox& box, int by)
{
  return {box.low - Cell::Constant(by), box.high + Cell::Constant(by)};
}

/** Patches that have cells of a box. */
CellBox patchesOf(const CellBox& cells)
{
  const auto patchOf = [](int cell) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / kPatch));
  };
  return {cells.low.unaryExpr(patchOf),
          (cells.high - Cell::Ones()).eval().unaryExpr(patchOf) + Cell::Ones()};
}

CellBox common(const CellBox& a, const CellBox& b)
{
  return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}
}  // namespace

struct VoxelShape::Patch
{
  Cell at;
  SignedSurface surface;
};

struct VoxelShape::Nearest
{
  const Patch* patch = nullptr;
  SignedSurface::Nearest at;
};

VoxelShape::VoxelShape(VoxelSet cells) : cells_(std::move(cells)) {}

VoxelShape::~VoxelShape() = default;
VoxelShape::VoxelShape(VoxelShape&&) noexcept = default;

bool VoxelShape::cover(const Box3& reach)
{
  const Box3 everything = bounds();
  if (!reach.overlaps(everything) || !reach.min.allFinite() || !reach.max.allFinite())
  {
    return false;
  }
  const CellBox cells = {cells_.cellOf(reach.min.cwiseMax(everything.min)),
                         cells_.cellOf(reach.max.cwiseMin(everything.max)) + Cell::Ones()};
  CellBox all = patchesOf(cells);
  all.extend(covered_);
  if (covered_.contains(all))
  {
    return false;
  }
  build(all);
  return true;
}

/** Makes the patches of a box of patches that there aren't yet. */
void VoxelShape::build(const CellBox& patches)
{
  Cell at;
  for (at.z() = patches.low.z(); at.z() < patches.high.z(); ++at.z())
  {
    for (at.y() = patches.low.y(); at.y() < patches.high.y(); ++at.y())
    {
      for (at.x() = patches.low.x(); at.x() < patches.high.x(); ++at.x())
      {
        if (covered_.contains({at, at + Cell::Ones()}) || !cells_.mixed(grown(cellsOf(at), 1)))
        {
          continue;
        }
        VoxelNet net = voxelNet(cells_, cellsOf(at));
        if (!net.mesh.triangles.empty())
        {
          patches_.push_back({at, {}});
          patches_.back().surface.build(std::move(net.mesh), std::move(net.normals), kOnSurface);
        }
      }
    }
  }
  covered_ = patches;
  std::sort(patches_.begin(), patches_.end(),
            [](const Patch& a, const Patch& b) { return before(a.at, b.at); });
  boxes_.clear();
  for (const Patch& patch : patches_)
  {
    boxes_.push_back(patch.surface.bounds());
  }
}

Box3 VoxelShape::covered() const
{
  Box3 box;
  if (!covered_.empty())
  {
    const double size = kPatch * cells_.cellSize();
    box.extend(Vec3(size * covered_.low.cast<double>()));
    box.extend(Vec3(size * covered_.high.cast<double>()));
  }
  return box;
}

bool VoxelShape::touches(const Box3& box) const
{
  return std::any_of(boxes_.begin(), boxes_.end(),
                     [&](const Box3& patch) { return patch.overlaps(box); });
}

void VoxelShape::change(const CellBox& box, bool occupied)
{
  cells_.fill(box, occupied);
  const CellBox stale = patchesOf(grown(box, voxelNetReach()));
  patches_.erase(std::remove_if(patches_.begin(), patches_.end(),
                                [&](const Patch& patch) {
                                  return stale.contains({patch.at, patch.at + Cell::Ones()});
                                }),
                 patches_.end());
  const CellBox all = covered_;
  const CellBox again = common(stale, all);
  if (!again.empty())
  {
    covered_ = CellBox();
    build(again);
    covered_ = all;
  }
}

// Patches are tried in the order of a list, ties go to the first: whatever else there is, the same
// triangle is found.
VoxelShape::Nearest VoxelShape::nearest(const Vec3& p) const
{
  std::size_t first = patches_.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < patches_.size(); ++i)
  {
    const double squared = boxes_[i].squaredDistance(p);
    if (squared < least)
    {
      least = squared;
      first = i;
    }
  }
  Nearest found;
  if (first == patches_.size())
  {
    return found;
  }
  const SignedSurface::Nearest bound = patches_[first].surface.nearest(p);
  // A little more than there is, so that ties are found as well.
  const double most = bound.at.squared_distance * (1.0 + 1e-12) + 1e-300;
  found = {&patches_[first], bound};
  for (std::size_t i = 0; i < patches_.size(); ++i)
  {
    if (i == first || boxes_[i].squaredDistance(p) > most)
    {
      continue;
    }
    const Patch& patch = patches_[i];
    const SignedSurface::Nearest other = patch.surface.nearest(p, most);
    if (other.triangle < 0)
    {
      continue;
    }
    const double difference = other.at.squared_distance - found.at.at.squared_distance;
    if (difference < 0.0 || (difference == 0.0 && before(patch.at, found.patch->at)))
    {
      found = {&patch, other};
    }
  }
  return found;
}

SignedDistance VoxelShape::distance(const Vec3& p) const
{
  const Nearest found = nearest(p);
  if (found.patch == nullptr)
  {
    const bool inside = cells_.occupied(cells_.cellOf(p));
    return {inside ? -kPatch * cells_.cellSize() : std::numeric_limits<double>::infinity(),
            Vec3::UnitZ()};
  }
  return found.patch->surface.distance(p, found.at);
}

Mat3 VoxelShape::curvature(const Vec3& p) const
{
  const Nearest found = nearest(p);
  return found.patch == nullptr ? Mat3(Mat3::Zero()) : found.patch->surface.curvature(p, found.at);
}

Box3 VoxelShape::bounds() const
{
  // Free cells in a solid world have their walls in the cells around them.
  Box3 box;
  const CellBox& cells = cells_.bounds();
  if (!cells.empty())
  {
    box.extend(Vec3(cells_.cellSize() * cells.low.cast<double>()));
    box.extend(Vec3(cells_.cellSize() * cells.high.cast<double>()));
    box.grow(cells_.cellSize());
  }
  return box;
}

SurfaceMesh VoxelShape::surface(double max_edge) const
{
  SurfaceMesh all;
  for (const Patch& patch : patches_)
  {
    const SurfaceMesh& mesh = patch.surface.mesh();
    const auto first = static_cast<Index>(all.nodes.size());
    all.nodes.insert(all.nodes.end(), mesh.nodes.begin(), mesh.nodes.end());
    for (const Triangle& t : mesh.triangles)
    {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  const double longest = 3.0 * cells_.cellSize();  // of a face's diagonal, its corners moved
  return max_edge > longest ? all : splitLongEdges(std::move(all), max_edge);
}

}  // namespace soft_tissue
