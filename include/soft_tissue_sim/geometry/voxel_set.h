#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue
{
/** Indices of a cell: it reaches from index * size to (index + 1) * size along each axis. */
using Cell = Eigen::Vector3i;

/** Cells from `low` up to, but not with, `high`; empty unless low < high along each axis. */
struct CellBox
{
  Cell low = Cell::Constant(1 << 30);
  Cell high = Cell::Constant(-(1 << 30));

  bool empty() const { return !(low.array() < high.array()).all(); }
  bool contains(const CellBox& other) const
  {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
  void extend(const CellBox& other)
  {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

/**
 * Which cells of a grid without end are occupied: a bit a cell, in bricks of 8 x 8 x 8, of which
 * only those exist that differ from the rest of the world.
 */
class VoxelSet
{
 public:
  /**
   * @param cell_size  edge length of a cell, m
   * @param occupied   what cells are that nothing was said of
   * @throws Error unless the size is positive and finite
   */
  explicit VoxelSet(double cell_size, bool occupied = false);

  double cellSize() const { return cell_size_; }

  /** @throws Error for indices beyond two to the 20th */
  void fill(const CellBox& box, bool occupied);
  void set(const Cell& cell, bool occupied) { fill({cell, cell + Cell::Ones()}, occupied); }

  bool occupied(const Cell& cell) const;

  /** Occupancy of all cells of a box, x running fastest, as 0 or 1. */
  void read(const CellBox& box, std::vector<std::uint8_t>& occupied) const;

  /** What cells are that nothing was said of. */
  bool othersOccupied() const { return others_occupied_; }

  /** Hash of which cells differ from those that nothing was said of: it does not depend on the way
   * they came to. */
  std::uint64_t contents() const { return contents_; }

  /** Box around the cells of a box that are not as in another set. */
  CellBox difference(const VoxelSet& other, const CellBox& box) const;

  /** Calls visit(cell) for each cell that differs from those that nothing was said of, brick by
   * brick, bricks by ascending z, y and x. */
  void forEachOther(const std::function<void(const Cell&)>& visit) const;

  /** Whether a box may have both kinds of cells. */
  bool mixed(const CellBox& box) const;

  /** Box around all cells that something was said of. */
  const CellBox& bounds() const { return bounds_; }

  Cell cellOf(const Vec3& p) const;

  /** Writes, or reads, all cells. @throws Error on reading those of another size */
  void exchange(StateArchive& archive);

  /** Memory of the bricks, bytes. */
  std::size_t bytes() const;

 private:
  static constexpr int kSide = 8;
  using Brick = std::array<std::uint64_t, kSide>;  ///< a bit set: unlike cells nothing was said of

  std::vector<std::uint64_t> sortedKeys() const;
  const Brick* brickAt(const Cell& brick) const;

  double cell_size_;
  bool others_occupied_;
  CellBox bounds_;
  std::uint64_t contents_ = 0;
  std::unordered_map<std::uint64_t, Brick> bricks_;
};

}  // namespace soft_tissue
