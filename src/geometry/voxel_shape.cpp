#include "soft_tissue_sim/geometry/voxel_shape.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "soft_tissue_sim/base/error.h"
#include "surface_grid.h"
#include "voxel_net.h"
#include "voxel_patch.h"

namespace soft_tissue
{
namespace
{
/** A ball about the surface that has lost its direction, in the size of a patch. */
constexpr double kOnSurface = 1e-12;

constexpr double kEverywhere = 1e9;  // m

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

/** Calls visit(at) for the patches of a box, ascending. */
template <typename Visit>
void forEachPatch(const CellBox& patches, const Visit& visit)
{
  Cell at;
  for (at.z() = patches.low.z(); at.z() < patches.high.z(); ++at.z())
  {
    for (at.y() = patches.low.y(); at.y() < patches.high.y(); ++at.y())
    {
      for (at.x() = patches.low.x(); at.x() < patches.high.x(); ++at.x())
      {
        visit(at);
      }
    }
  }
}
}  // namespace

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
  forEachPatch(patches, [&](const Cell& at) {
    if (!covered_.contains({at, at + Cell::Ones()}))
    {
      addPatch(at);
    }
  });
  covered_ = patches;
  finishPatches();
}

void VoxelShape::addPatch(const Cell& at)
{
  if (!cells_.mixed(grown(cellsOf(at), 1)))
  {
    return;
  }
  VoxelNet net = voxelNet(cells_, cellsOf(at));
  if (!net.mesh.triangles.empty())
  {
    patches_.push_back({at, {}});
    patches_.back().surface.build(std::move(net.mesh), std::move(net.normals), kOnSurface);
  }
}

void VoxelShape::finishPatches()
{
  std::sort(patches_.begin(), patches_.end(),
            [](const Patch& a, const Patch& b) { return before(a.at, b.at); });
  boxes_.clear();
  for (const Patch& patch : patches_)
  {
    boxes_.push_back(patch.surface.bounds());
  }
  static std::atomic<std::uint64_t> versions{0};
  version_ = ++versions;
}

void VoxelShape::remake(VoxelSet cells, const CellBox& patches)
{
  cells_ = std::move(cells);
  patches_.clear();
  covered_ = CellBox();
  build(patches);
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

/** Covered patches whose surface depends on a cell that is not as in another set, ascending. */
std::vector<Cell> VoxelShape::stalePatches(const VoxelSet& cells) const
{
  std::vector<Cell> stale;
  forEachPatch(covered_.empty() ? covered_ : grown(covered_, 1), [&](const Cell& at) {
    const CellBox differ = cells_.difference(cells, cellsOf(at));
    if (differ.empty())
    {
      return;
    }
    forEachPatch(patchesOf(grown(differ, voxelNetReach())), [&](const Cell& near) {
      if (covered_.contains({near, near + Cell::Ones()}))
      {
        stale.push_back(near);
      }
    });
  });
  std::sort(stale.begin(), stale.end(), before);
  stale.erase(std::unique(stale.begin(), stale.end()), stale.end());
  return stale;
}

std::optional<Box3> VoxelShape::changes(const VoxelSet& cells) const
{
  if (cells.othersOccupied() != cells_.othersOccupied())
  {
    return Box3{Vec3::Constant(-kEverywhere), Vec3::Constant(kEverywhere)};
  }
  std::optional<Box3> box;
  const auto take = [&](const CellBox& changed) {
    box = box.value_or(Box3());
    box->extend(Vec3(cells_.cellSize() * changed.low.cast<double>()));
    box->extend(Vec3(cells_.cellSize() * changed.high.cast<double>()));
  };
  for (const Cell& at : stalePatches(cells))
  {
    take(cellsOf(at));
  }
  // What is beyond all that there is has never been covered.
  if (!cells_.bounds().contains(cells.bounds()))
  {
    take(cells.bounds());
  }
  return box;
}

VoxelSet VoxelShape::exchange(VoxelSet cells)
{
  if (cells.cellSize() != cells_.cellSize())
  {
    throw Error("voxels: cells of " + std::to_string(cells.cellSize()) +
                " m can't take the place of cells of " + std::to_string(cells_.cellSize()) + " m");
  }
  const std::vector<Cell> stale = stalePatches(cells);
  std::swap(cells_, cells);
  const auto isStale = [&](const Patch& patch) {
    return std::binary_search(stale.begin(), stale.end(), patch.at, before);
  };
  patches_.erase(std::remove_if(patches_.begin(), patches_.end(), isStale), patches_.end());
  for (const Cell& at : stale)
  {
    addPatch(at);
  }
  finishPatches();
  return cells;
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
