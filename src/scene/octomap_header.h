#pragma once

#include <cstdint>
#include <string>

namespace soft_tissue
{
/** What the text before the data of an OctoMap file says. */
struct OctomapHeader
{
  bool binary = false;  ///< occupied or free (.bt), not how likely (.ot)
  bool colour = false;  ///< nodes have a colour as well
  std::uint64_t nodes = 0;
  double resolution = 0.0;  ///< edge length of the finest cells, m
  std::size_t data_begin = 0;
};

/** @throws Error saying what is wrong, without the file's name */
OctomapHeader readOctomapHeader(const std::string& bytes);

/**
 * Walks the tree as a reader would: liboctomap itself trusts its input, and runs on at its end.
 * @throws Error saying what is wrong, without the file's name
 */
void checkOctomapData(const std::string& bytes, const OctomapHeader& header);

}  // namespace soft_tissue
