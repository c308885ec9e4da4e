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
constexpr int kTreeDepth = 16;

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

/** Follows the nodes of a tree in the order they are stored in. */
class TreeWalk
{
 public:
  TreeWalk(const std::string& bytes, const OctomapHeader& header)
      : bytes_(bytes), at_(header.data_begin), binary_(header.binary), value_(header.colour ? 7 : 4)
  {}

  std::uint64_t nodes() const { return nodes_; }

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
  std::size_t at_;
  bool binary_;
  std::size_t value_;  ///< bytes of a node before those of its children
  std::uint64_t nodes_ = 0;
};
}  // namespace

OctomapHeader readOctomapHeader(const std::string& bytes)
{
  std::istringstream stream(bytes);
  std::string line;
  std::getline(stream, line);
  OctomapHeader header;
  header.binary = startsWith(line, kBinary);
  if (!header.binary && !startsWith(line, kFull))
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
      header.resolution = valueOf<double>(key, value);
      has_resolution = true;
    }
  }
  if (line != "data" || id.empty() || !has_size || !has_resolution)
  {
    throw Error("header: must have id, size, res and data");
  }
  header.colour = id == "ColorOcTree" && !header.binary;
  if (id != "OcTree" && id != "ColorOcTree")
  {
    throw Error("header: id = " + id + ", must be OcTree or ColorOcTree");
  }
  if (!(header.resolution > 0.0) || !std::isfinite(header.resolution))
  {
    std::ostringstream resolution;
    resolution << header.resolution;
    throw Error("header: res = " + resolution.str() + ", must be above 0");
  }
  header.data_begin = static_cast<std::size_t>(stream.tellg());
  return header;
}

void checkOctomapData(const std::string& bytes, const OctomapHeader& header)
{
  if (header.nodes == 0)
  {
    return;
  }
  TreeWalk walk(bytes, header);
  walk.walk(0);
  if (walk.nodes() != header.nodes)
  {
    throw Error("header: size = " + std::to_string(header.nodes) + ", but its tree has " +
                std::to_string(walk.nodes()) + " nodes: damaged?");
  }
}

}  // namespace soft_tissue
