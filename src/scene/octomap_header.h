#pragma once

#include <cstdint>
#include <string>

#include "octomap_tree.h"

namespace soft_tissue
{
/** What the text before the data of an OctoMap file says. */
struct OctomapHeader
{
  OctomapFormat format;
  std::uint64_t nodes = 0;
  std::size_t data_begin = 0;
};

/** @throws Error saying what is wrong, without the file's name */
OctomapHeader readOctomapHeader(const std::string& bytes);

/** Counts the nodes of the tree that stands after the header.
 * @throws Error saying what is wrong, without the file's name */
void checkOctomapData(const std::string& data, const OctomapHeader& header);

}  // namespace soft_tissue
