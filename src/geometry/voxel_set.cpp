#include "soft_tissue_sim/geometry/voxel_set.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr int kLargest = 1 << 20;

Cell brickOf(const Cell& cell)
{
  return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3};
}

std::uint64_t keyOf(const Cell& brick)
{
  const auto part = [&](int axis) { return static_cast<std::uint64_t>(brick[axis] + kLargest); };
  return part(0) | part(1) << 21U | part(2) << 42U;
}

Cell brickWith(std::uint64_t key)
{
  const auto part = [&](unsigned shift) {
    return static_cast<int>(key >> shift & (2U * kLargest - 1U)) - kLargest;
  };
  return {part(0), part(21), part(42)};
}

template <typename Visit>
void forEachCell(const CellBox& box, const Visit& visit)
{
  Cell cell;
  for (cell.z() = box.low.z(); cell.z() < box.high.z(); ++cell.z())
  {
    for (cell.y() = box.low.y(); cell.y() < box.high.y(); ++cell.y())
    {
      for (cell.x() = box.low.x(); cell.x() < box.high.x(); ++cell.x())
      {
        visit(cell);
      }
    }
  }
}

/** Bricks that have cells of a box. */
CellBox bricksOf(const CellBox& box)
{
  return {brickOf(box.low), brickOf(box.high - Cell::Ones()) + Cell::Ones()};
}

/** A number of its own for each cell, as random as it gets: those of a set are joined by xor.
 * Source: [Steele2014] figure 16, its mixing function */
std::uint64_t codeOf(std::uint64_t brick_key, const Cell& cell)
{
  const auto mixed = [](std::uint64_t code) {
    code = (code ^ code >> 30U) * 0xbf58476d1ce4e5b9ULL;
    code = (code ^ code >> 27U) * 0x94d049bb133111ebULL;
    return code ^ code >> 31U;
  };
  const int at = (cell.x() & 7) + 8 * (cell.y() & 7) + 64 * (cell.z() & 7);
  return mixed(mixed(brick_key + 0x9e3779b97f4a7c15ULL) + static_cast<std::uint64_t>(at + 1));
}

unsigned bitOf(const Cell& cell)
{
  return static_cast<unsigned>((cell.x() & 7) + 8 * (cell.y() & 7));
}
}  // namespace

VoxelSet::VoxelSet(double cell_size, bool occupied)
    : cell_size_(cell_size), others_occupied_(occupied)
{
  if (!(cell_size > 0.0) || !std::isfinite(cell_size))
  {
    throw Error("voxels: edge length = " + std::to_string(cell_size) +
                ", must be positive and finite");
  }
}

void VoxelSet::fill(const CellBox& box, bool occupied)
{
  if (box.empty())
  {
    return;
  }
  if ((box.low.array() < -kLargest).any() || (box.high.array() > kLargest).any())
  {
    throw Error("voxels: a cell's index is beyond " + std::to_string(kLargest));
  }
  bounds_.extend(box);
  const bool bit = occupied != others_occupied_;
  forEachCell(bricksOf(box), [&](const Cell& brick) {
    const Cell first = brick * kSide;
    const CellBox part = {first.cwiseMax(box.low),
                          (first + Cell::Constant(kSide)).cwiseMin(box.high)};
    const std::uint64_t key = keyOf(brick);
    Brick& bits = bricks_[key];
    forEachCell(part, [&](const Cell& cell) {
      const std::uint64_t mask = std::uint64_t{1} << bitOf(cell);
      std::uint64_t& layer = bits[cell.z() & 7];
      if (((layer & mask) != 0) != bit)
      {
        layer ^= mask;
        contents_ ^= codeOf(key, cell);
      }
    });
  });
}

const VoxelSet::Brick* VoxelSet::brickAt(const Cell& brick) const
{
  const auto found = bricks_.find(keyOf(brick));
  return found == bricks_.end() ? nullptr : &found->second;
}

bool VoxelSet::occupied(const Cell& cell) const
{
  const bool far = (cell.array() < -kLargest).any() || (cell.array() >= kLargest).any();
  const Brick* brick = far ? nullptr : brickAt(brickOf(cell));
  return others_occupied_ !=
         (brick != nullptr && ((*brick)[cell.z() & 7] >> bitOf(cell) & 1U) != 0);
}

void VoxelSet::read(const CellBox& box, std::vector<std::uint8_t>& occupied) const
{
  const Cell size = box.high - box.low;
  occupied.assign(static_cast<std::size_t>(size.x()) * size.y() * size.z(), others_occupied_);
  forEachCell(bricksOf(box), [&](const Cell& brick) {
    const Brick* bits = brickAt(brick);
    if (bits == nullptr)
    {
      return;
    }
    const Cell first = brick * kSide;
    const CellBox part = {first.cwiseMax(box.low),
                          (first + Cell::Constant(kSide)).cwiseMin(box.high)};
    forEachCell(part, [&](const Cell& cell) {
      const Cell at = cell - box.low;
      const bool bit = ((*bits)[cell.z() & 7] >> bitOf(cell) & 1U) != 0;
      occupied[(static_cast<std::size_t>(at.z()) * size.y() + at.y()) * size.x() + at.x()] =
          bit != others_occupied_;
    });
  });
}

CellBox VoxelSet::difference(const VoxelSet& other, const CellBox& box) const
{
  static constexpr Brick kAlike = {};
  const std::uint64_t flipped = others_occupied_ == other.others_occupied_ ? 0 : ~std::uint64_t{0};
  CellBox found;
  forEachCell(bricksOf(box), [&](const Cell& brick) {
    const Brick* mine = brickAt(brick);
    const Brick* theirs = other.brickAt(brick);
    if (mine == nullptr && theirs == nullptr && flipped == 0)
    {
      return;
    }
    const Cell first = brick * kSide;
    for (int z = 0; z < kSide; ++z)
    {
      const std::uint64_t differ = (mine == nullptr ? kAlike : *mine)[z] ^
                                   (theirs == nullptr ? kAlike : *theirs)[z] ^ flipped;
      for (int bit = 0; differ != 0 && bit < 64; ++bit)
      {
        const Cell cell = first + Cell(bit & 7, bit >> 3, z);
        const CellBox one = {cell, cell + Cell::Ones()};
        if ((differ >> bit & 1U) != 0 && box.contains(one))
        {
          found.extend(one);
        }
      }
    }
  });
  return found;
}

/** z is in the highest bits. */
std::vector<std::uint64_t> VoxelSet::sortedKeys() const
{
  std::vector<std::uint64_t> keys;
  keys.reserve(bricks_.size());
  for (const auto& [key, bits] : bricks_)
  {
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

void VoxelSet::exchange(StateArchive& archive)
{
  double cell_size = cell_size_;
  archive.value(cell_size);
  if (cell_size != cell_size_)
  {
    throw Error("voxels: cells of " + std::to_string(cell_size) + " m, must be of " +
                std::to_string(cell_size_) + " m");
  }
  archive.value(others_occupied_);
  for (Cell* corner : {&bounds_.low, &bounds_.high})
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      archive.value((*corner)[axis]);
    }
  }
  archive.value(contents_);
  std::vector<std::uint64_t> keys = sortedKeys();
  archive.list(keys);
  if (archive.reading())
  {
    bricks_.clear();
  }
  for (const std::uint64_t key : keys)
  {
    archive.value(bricks_[key]);
  }
}

void VoxelSet::forEachOther(const std::function<void(const Cell&)>& visit) const
{
  for (const std::uint64_t key : sortedKeys())
  {
    const Cell first = brickWith(key) * kSide;
    const Brick& bits = bricks_.at(key);
    for (int at = 0; at < kSide * kSide * kSide; ++at)
    {
      if ((bits[at >> 6] >> (at & 63) & 1U) != 0)
      {
        visit(first + Cell(at & 7, at >> 3 & 7, at >> 6));
      }
    }
  }
}

bool VoxelSet::mixed(const CellBox& box) const
{
  bool any = false;
  forEachCell(bricksOf(box), [&](const Cell& brick) { any = any || brickAt(brick) != nullptr; });
  return any;
}

Cell VoxelSet::cellOf(const Vec3& p) const
{
  // A point that is not finite, or out of the grid, is in a cell at its end.
  const Vec3 index = (p / cell_size_).array().floor().matrix();
  Cell cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    cell[axis] = index[axis] > -kLargest
                     ? (index[axis] < kLargest ? static_cast<int>(index[axis]) : kLargest)
                     : -kLargest;
  }
  return cell;
}

std::size_t VoxelSet::bytes() const
{
  return bricks_.size() * (sizeof(Brick) + sizeof(std::uint64_t) + 2 * sizeof(void*));
}

}  // namespace soft_tissue
