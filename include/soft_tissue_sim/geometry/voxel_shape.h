#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "soft_tissue_sim/geometry/voxel_set.h"

namespace soft_tissue
{
/**
 * The solid of the occupied cells of a grid, its surface smoothed within a part of a cell: flat
 * walls along the grid stay exactly where they are, stairs become slopes, a wall of one cell keeps
 * its thickness. Its distance is exact to that surface.
 *
 * The surface exists in patches, and only where cover() asked for it: of a large map only the
 * neighbourhood of what may touch it. Where patches are asked for, and in what order, changes no
 * bit of a distance, as long as the nearest surface is covered. Const members may run from several
 * threads at once.
 */
class VoxelShape : public RigidShape
{
 public:
  explicit VoxelShape(VoxelSet cells);
  ~VoxelShape() override;
  VoxelShape(VoxelShape&&) noexcept;

  const VoxelSet& cells() const { return cells_; }

  /**
   * Makes the surface there is in a box, and in the box around it and those before.
   * @param reach  m, shape frame
   * @return whether that took anything new
   */
  bool cover(const Box3& reach);

  /** What cover() was asked for, rounded up to patches, m; empty at first. */
  Box3 covered() const;

  /** Whether a covered piece of the surface may be in a box, shape frame. */
  bool touches(const Box3& box) const;

  /**
   * A box, m, shape frame, out of which its surface would stay the same with other cells; none: all
   * of it would. Of what there is it looks at what is covered alone, however large the map.
   */
  std::optional<Box3> changes(const VoxelSet& cells) const;

  /**
   * Takes other cells and makes anew the covered patches that this changes.
   * @return those there were
   * @throws Error for cells of another size
   */
  VoxelSet exchange(VoxelSet cells);

  /** What is covered, in patches. */
  const CellBox& coveredPatches() const { return covered_; }
  /** Takes other cells of the same size, and covers these patches and no others. */
  void remake(VoxelSet cells, const CellBox& patches);

  /**
   * Exact wherever the nearest surface is covered. Where no surface is, infinite in the open, and
   * minus the size of a patch inside, with an arbitrary normal.
   */
  SignedDistance distance(const Vec3& p) const override;
  Mat3 curvature(const Vec3& p) const override;
  SignedDistance distance(const Vec3& p, NearestHint& hint) const override;
  Mat3 curvature(const Vec3& p, NearestHint& hint) const override;
  bool searches() const override { return true; }
  /** Bounds of the whole surface, covered or not. */
  Box3 bounds() const override;
  bool convex() const override { return false; }
  /** Half a cell: what fits into the thinnest wall. */
  double innerRadius() const override { return 0.5 * cells_.cellSize(); }
  /** What is covered of it; open where the covered box ends. */
  SurfaceMesh surface(double max_edge) const override;

 private:
  struct Patch;
  struct Nearest;
  void build(const CellBox& patches);
  void addPatch(const Cell& at);
  void finishPatches();
  std::vector<Cell> stalePatches(const VoxelSet& cells) const;
  Nearest nearest(const Vec3& p, NearestHint* hint) const;
  Nearest search(const Vec3& p, const Nearest& known) const;
  void remember(const Vec3& p, const Nearest& found, NearestHint& hint) const;
  SignedDistance distanceTo(const Nearest& found, const Vec3& p) const;
  Mat3 curvatureOf(const Nearest& found, const Vec3& p) const;

  VoxelSet cells_;
  CellBox covered_;             ///< in patches
  std::vector<Patch> patches_;  ///< those with a surface, ascending
  std::vector<Box3> boxes_;     ///< theirs
  std::uint64_t version_ = 0;   ///< of the patches, no other shape's
};

}  // namespace soft_tissue
