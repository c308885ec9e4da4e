#include "octomap_header.h"

#include <cmath>
#include <sstream>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr const char* kBinary = "# Octomap OcTree binary file";
constexpr const char* kFull = "# Octomap OcTree file";

bool startsWith(const std::string& text, const std::string& start)
{
  return text.compare(0, start.size(), start) == 0;
}

template <typename T>
T valueOf(const std::string& key, const std::string& text)
{
  std::istringstream stream(text);
  T value{};
  std::string rest;
  if (!(stream >> value) || stream >> rest)
  {
    throw Error("header: '" + key + "' = '" + text + "', must be a number");
  }
  return value;
}

}  // namespace

OctomapHeader readOctomapHeader(const std::string& bytes)
{
  std::istringstream stream(bytes);
  std::string line;
  std::getline(stream, line);
  OctomapHeader header;
  header.format.binary = startsWith(line, kBinary);
  if (!header.format.binary && !startsWith(line, kFull))
  {
    throw Error(std::string("is no OctoMap: its first line must be '") + kBinary + "' or '" +
                kFull + "' (octomap-tools' convert_octree updates files from before 1.0)");
  }
  std::string id;
  bool has_size = false, has_resolution = false;
  while (std::getline(stream, line) && line != "data")
  {
    const std::size_t space = line.find(' ');
    const std::string key = line.substr(0, space);
    const std::string value = space == std::string::npos ? "" : line.substr(space + 1);
    if (key == "id")
    {
      id = value;
    }
    else if (key == "size")
    {
      header.nodes = valueOf<std::uint64_t>(key, value);
      has_size = true;
    }
    else if (key == "res")
    {
      header.format.resolution = valueOf<double>(key, value);
      has_resolution = true;
    }
  }
  if (line != "data" || id.empty() || !has_size || !has_resolution)
  {
    throw Error("header: must have id, size, res and data");
  }
  header.format.colour = id == "ColorOcTree" && !header.format.binary;
  if (id != "OcTree" && id != "ColorOcTree")
  {
    throw Error("header: id = " + id + ", must be OcTree or ColorOcTree");
  }
  if (!(header.format.resolution > 0.0) || !std::isfinite(header.format.resolution))
  {
    std::ostringstream resolution;
    resolution << header.format.resolution;
    throw Error("header: res = " + resolution.str() + ", must be above 0");
  }
  header.data_begin = static_cast<std::size_t>(stream.tellg());
  return header;
}

void checkOctomapData(const std::string& data, const OctomapHeader& header)
{
  if (header.nodes == 0)
  {
    return;
  }
  const std::uint64_t nodes = countOctomapNodes(data, header.format);
  if (nodes != header.nodes)
  {
    throw Error("header: size = " + std::to_string(header.nodes) + ", but its tree has " +
                std::to_string(nodes) + " nodes: damaged?");
  }
}

}  // namespace soft_tissue
