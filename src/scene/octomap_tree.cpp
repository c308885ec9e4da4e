#include "octomap_tree.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr int kTreeDepth = 16;
constexpr int kMiddleKey = 1 << (kTreeDepth - 1);
constexpr std::int64_t kMostCells = std::int64_t{1} << 27U;

struct CellOrder
{
  bool operator()(const Cell& a, const Cell& b) const
  {
    return std::tie(a.z(), a.y(), a.x()) < std::tie(b.z(), b.y(), b.x());
  }
};

/** Takes the leaves of an octree into a set of cells that may be larger than the leaves. */
class CellTaker
{
 public:
  CellTaker(double resolution, const OctomapConfig& config)
      : level_(kTreeDepth - config.depth),
        unknown_occupied_(config.unknown_occupied),
        cells_(resolution * (1 << level_), config.unknown_occupied)
  {}

  /** @param size  edge length of a leaf in finest cells, a power of two */
  void take(const Cell& low, int size, bool occupied)
  {
    // What differs from cells that nothing was said of.
    if (occupied == unknown_occupied_)
    {
      return;
    }
    const Cell first(low.x() >> level_, low.y() >> level_, low.z() >> level_);
    const int side = std::max(size >> level_, 1);
    taken_ += static_cast<std::int64_t>(side) * side * side;
    if (taken_ > kMostCells)
    {
      return;
    }
    const std::int64_t whole = std::int64_t{1} << 3U * level_;
    const std::int64_t part = static_cast<std::int64_t>(size) * size * size;
    // A larger cell is free only where all of it is.
    if (occupied || part >= whole || (free_[first] += part) == whole)
    {
      cells_.fill({first, first + Cell::Constant(side)}, occupied);
    }
  }

  std::int64_t taken() const { return taken_; }
  VoxelSet& cells() { return cells_; }

 private:
  int level_;
  bool unknown_occupied_;
  VoxelSet cells_;
  std::int64_t taken_ = 0;
  std::map<Cell, std::int64_t, CellOrder> free_;  ///< finest cells of larger ones
};

/** Follows the nodes of a tree in the order they are stored in. */
class TreeWalk
{
 public:
  TreeWalk(const std::string& bytes, const OctomapFormat& format)
      : bytes_(bytes), binary_(format.binary), value_(format.colour ? 7 : 4)
  {}

  std::uint64_t nodes() const { return nodes_; }
  std::size_t end() const { return at_; }

  void walk(int depth)
  {
    ++nodes_;
    const std::size_t length = binary_ ? 2 : value_ + 1;
    if (bytes_.size() - at_ < length)
    {
      throw Error("ends within node " + std::to_string(nodes_) + " of its tree: truncated?");
    }
    const auto byte = [&](std::size_t i) {
      return static_cast<unsigned>(static_cast<unsigned char>(bytes_[at_ + i]));
    };
    const unsigned pairs = binary_ ? byte(0) | byte(1) << 8U : 0;
    const unsigned inner = binary_ ? 0 : byte(value_);
    at_ += length;
    for (unsigned child = 0; child < 8; ++child)
    {
      const unsigned pair = pairs >> 2U * child & 3U;
      const bool below = binary_ ? pair == 3 : (inner >> child & 1U) != 0;
      if (below && depth + (binary_ ? 2 : 1) > kTreeDepth)
      {
        throw Error("node " + std::to_string(nodes_) + " has children below depth 16: damaged?");
      }
      if (below)
      {
        walk(depth + 1);
      }
      else if (pair != 0)
      {
        ++nodes_;
      }
    }
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool binary_;
  std::size_t value_;  ///< bytes of a node before those of its children
  std::uint64_t nodes_ = 0;
};
template <typename Tree>
void takeLeaves(const std::string& data, const OctomapFormat& format, CellTaker& taker)
{
  Tree tree(format.resolution);
  std::istringstream stream(data);
  if (format.binary)
  {
    tree.readBinaryData(stream);
  }
  else
  {
    tree.readData(stream);
  }
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
  {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    taker.take(Cell(key[0], key[1], key[2]) - Cell::Constant(kMiddleKey),
               1 << (kTreeDepth - leaf.getDepth()), tree.isNodeOccupied(*leaf));
  }
}
}  // namespace

std::uint64_t countOctomapNodes(const std::string& data, const OctomapFormat& format)
{
  TreeWalk walk(data, format);
  walk.walk(0);
  if (walk.end() != data.size())
  {
    throw Error(std::to_string(data.size() - walk.end()) + " bytes follow its tree: damaged?");
  }
  return walk.nodes();
}

VoxelSet octomapTreeCells(const std::string& data, const OctomapFormat& format,
                          const OctomapConfig& config)
{
  CellTaker taker(format.resolution, config);
  format.colour ? takeLeaves<octomap::ColorOcTree>(data, format, taker)
                : takeLeaves<octomap::OcTree>(data, format, taker);
  if (taker.taken() > kMostCells)
  {
    throw Error("has more than " + std::to_string(kMostCells) +
                " cells at this depth; a smaller depth takes larger ones");
  }
  return std::move(taker.cells());
}

}  // namespace soft_tissue
