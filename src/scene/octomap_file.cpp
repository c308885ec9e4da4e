#include "octomap_file.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <tuple>

#include "octomap_header.h"
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

template <typename Tree>
void takeLeaves(const std::string& data, const OctomapHeader& header, CellTaker& taker)
{
  Tree tree(header.resolution);
  std::istringstream stream(data);
  if (header.binary)
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

VoxelSet readOctomap(const OctomapConfig& config, const std::string& where)
{
  const auto reject = [&](const std::string& complaint) {
    throw Error(where + ".file = " + config.file + ", " + complaint);
  };
  std::ifstream file(config.file, std::ios::binary);
  if (!file.good())
  {
    reject("can't be read");
  }
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  OctomapHeader header;
  try
  {
    header = readOctomapHeader(bytes);
    checkOctomapData(bytes, header);
  }
  catch (const Error& error)
  {
    reject(error.what());
  }
  CellTaker taker(header.resolution, config);
  if (header.nodes > 0)
  {
    const std::string data = bytes.substr(header.data_begin);
    header.colour ? takeLeaves<octomap::ColorOcTree>(data, header, taker)
                  : takeLeaves<octomap::OcTree>(data, header, taker);
  }
  if (taker.taken() > kMostCells)
  {
    reject("has more than " + std::to_string(kMostCells) +
           " cells at this depth; a smaller depth takes larger ones");
  }
  if (taker.cells().bounds().empty())
  {
    reject(config.unknown_occupied ? "has no free cells" : "has no occupied cells");
  }
  return std::move(taker.cells());
}

}  // namespace soft_tissue
