#include "soft_tissue_sim/scene/octomap_data.h"

#include <octomap/OcTree.h>

#include <cmath>
#include <sstream>

#include "octomap_tree.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr int kMiddleKey = 1 << 15;
/** Some senders have worked the resolution out in single precision. */
constexpr double kSameResolution = 1e-6;

std::string textOf(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}
}  // namespace

VoxelSet octomapCells(const OctomapData& octomap, const OctomapConfig& config)
{
  if (octomap.id != "OcTree" && octomap.id != "ColorOcTree")
  {
    throw Error("id = '" + octomap.id + "', must be OcTree or ColorOcTree");
  }
  if (!(std::abs(octomap.resolution - config.resolution_m) <=
        kSameResolution * config.resolution_m))
  {
    throw Error("resolution = " + textOf(octomap.resolution) + ", must be the scene's, " +
                textOf(config.resolution_m));
  }
  const OctomapFormat format = {octomap.binary, octomap.id == "ColorOcTree" && !octomap.binary,
                                config.resolution_m};
  if (octomap.bytes.empty())
  {
    return VoxelSet(config.resolution_m * (1 << (16 - config.depth)), config.unknown_occupied);
  }
  countOctomapNodes(octomap.bytes, format);
  return octomapTreeCells(octomap.bytes, format, config);
}

OctomapData octomapOf(const VoxelSet& cells, const VoxelSet& known, bool binary)
{
  octomap::OcTree tree(cells.cellSize());
  const auto set = [&](const Cell& cell, bool occupied) {
    if ((cell.array() < -kMiddleKey).any() || (cell.array() >= kMiddleKey).any())
    {
      return;
    }
    const octomap::OcTreeKey key(static_cast<octomap::key_type>(cell.x() + kMiddleKey),
                                 static_cast<octomap::key_type>(cell.y() + kMiddleKey),
                                 static_cast<octomap::key_type>(cell.z() + kMiddleKey));
    tree.setNodeValue(key, occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(),
                      true);
  };
  known.forEachOther([&](const Cell& cell) {
    if (!cells.occupied(cell))
    {
      set(cell, false);
    }
  });
  cells.forEachOther([&](const Cell& cell) { set(cell, true); });
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream stream;
  binary ? tree.writeBinaryData(stream) : tree.writeData(stream);
  return {binary, tree.getTreeType(), cells.cellSize(), stream.str()};
}

}  // namespace soft_tissue
