#include "octomap_file.h"

#include <fstream>
#include <iterator>

#include "octomap_header.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
VoxelSet readOctomap(const OctomapConfig& config, const std::string& where)
{
  std::ifstream file(config.file, std::ios::binary);
  try
  {
    if (!file.good())
    {
      throw Error("can't be read");
    }
    const std::string bytes((std::istreambuf_iterator<char>(file)),
                            std::istreambuf_iterator<char>());
    const OctomapHeader header = readOctomapHeader(bytes);
    const std::string data = bytes.substr(header.data_begin);
    checkOctomapData(data, header);
    VoxelSet cells(header.format.resolution * (1 << (16 - config.depth)), config.unknown_occupied);
    if (header.nodes > 0)
    {
      cells = octomapTreeCells(data, header.format, config);
    }
    if (cells.bounds().empty())
    {
      throw Error(config.unknown_occupied ? "has no free cells" : "has no occupied cells");
    }
    return cells;
  }
  catch (const Error& error)
  {
    throw Error(where + ".file = " + config.file + ", " + error.what());
  }
}

}  // namespace soft_tissue
