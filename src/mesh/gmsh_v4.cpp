#include <cstdint>
#include <cstdlib>

#include "gmsh_reader.h"

namespace soft_tissue
{
namespace
{
constexpr int kVolume = 3;
}  // namespace

void GmshReader::readEntities4()
{
  if (binary_)
  {
    cursor_.endLine();
  }
  std::size_t counts[4];
  for (std::size_t& count : counts)
  {
    const auto declared = cursor_.value<std::int64_t>("a number of entities");
    count = cursor_.checkedCount(declared, binary_ ? 36 : 9, "entities");
  }
  for (int dimension = 0; dimension < 4; ++dimension)
  {
    for (std::size_t i = 0; i < counts[dimension]; ++i)
    {
      const int entity = cursor_.value<std::int32_t>("an entity tag");
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k)
      {
        cursor_.value<double>("an entity's box");
      }
      const auto physical_count =
          cursor_.checkedCount(cursor_.value<std::int64_t>("a number of physical tags"),
                               binary_ ? 4 : 2, "physical tags");
      for (std::size_t k = 0; k < physical_count; ++k)
      {
        const int physical = std::abs(cursor_.value<std::int32_t>("a physical tag"));
        if (dimension == kVolume && k == 0)
        {
          volume_tag_[entity] = physical;
        }
      }
      if (dimension > 0)
      {
        const auto bounding_count =
            cursor_.checkedCount(cursor_.value<std::int64_t>("a number of bounding entities"),
                                 binary_ ? 4 : 2, "entities");
        for (std::size_t k = 0; k < bounding_count; ++k)
        {
          cursor_.value<std::int32_t>("a bounding entity");
        }
      }
    }
  }
}

void GmshReader::readNodes4()
{
  if (binary_)
  {
    cursor_.endLine();
  }
  const auto blocks = cursor_.value<std::int64_t>("the number of blocks");
  const auto declared = cursor_.value<std::int64_t>("the number of nodes");
  cursor_.value<std::int64_t>("the smallest node number");
  cursor_.value<std::int64_t>("the largest node number");
  const std::size_t count = cursor_.checkedCount(declared, binary_ ? 32 : 8, "nodes");
  const std::size_t block_count = cursor_.checkedCount(blocks, binary_ ? 20 : 8, "blocks");
  std::vector<long long> numbers;
  for (std::size_t b = 0; b < block_count; ++b)
  {
    const int dimension = cursor_.value<std::int32_t>("a block's dimension");
    cursor_.value<std::int32_t>("a block's entity");
    const bool parametric = cursor_.value<std::int32_t>("the parametric flag") != 0;
    const auto here = cursor_.value<std::int64_t>("a block's number of nodes");
    numbers.resize(cursor_.checkedCount(here, binary_ ? 32 : 8, "nodes"));
    if (numbers.size() > count - builder_.nodeCount() || dimension < 0 || dimension > kVolume)
    {
      cursor_.fail("a block of dimension " + std::to_string(dimension) + " with " +
                   std::to_string(here) + " nodes, where " +
                   std::to_string(count - builder_.nodeCount()) + " are left");
    }
    for (long long& number : numbers)
    {
      number = cursor_.value<std::int64_t>("a node number");
    }
    for (const long long number : numbers)
    {
      const double x = cursor_.value<double>("a node's x");
      const double y = cursor_.value<double>("a node's y");
      const double z = cursor_.value<double>("a node's z");
      addNode(number, x, y, z);
      for (int k = 0; parametric && k < dimension; ++k)
      {
        cursor_.value<double>("a node's parameter");
      }
    }
  }
  if (builder_.nodeCount() != count)
  {
    cursor_.fail("declares " + std::to_string(count) + " nodes, but its blocks hold " +
                 std::to_string(builder_.nodeCount()));
  }
}

void GmshReader::readElements4()
{
  if (binary_)
  {
    cursor_.endLine();
  }
  const auto blocks = cursor_.value<std::int64_t>("the number of blocks");
  const auto declared = cursor_.value<std::int64_t>("the number of elements");
  cursor_.value<std::int64_t>("the smallest element number");
  cursor_.value<std::int64_t>("the largest element number");
  const std::size_t count = cursor_.checkedCount(declared, binary_ ? 16 : 4, "elements");
  const std::size_t block_count = cursor_.checkedCount(blocks, binary_ ? 20 : 8, "blocks");
  std::size_t done = 0;
  std::vector<long long> nodes;
  for (std::size_t b = 0; b < block_count; ++b)
  {
    cursor_.value<std::int32_t>("a block's dimension");
    const int entity = cursor_.value<std::int32_t>("a block's entity");
    const int type = cursor_.value<std::int32_t>("a block's element type");
    const auto here = cursor_.value<std::int64_t>("a block's number of elements");
    nodes.resize(nodesOfType(type));
    if (here < 0 || static_cast<std::size_t>(here) > count - done)
    {
      cursor_.fail("a block of " + std::to_string(here) + " elements, where " +
                   std::to_string(count - done) + " are left");
    }
    const auto physical = volume_tag_.find(entity);
    const int tag =
        physical == volume_tag_.end() || physical->second == 0 ? entity : physical->second;
    for (std::int64_t i = 0; i < here; ++i)
    {
      cursor_.value<std::int64_t>("an element number");
      for (long long& node : nodes)
      {
        node = cursor_.value<std::int64_t>("an element's node");
      }
      addElement(type, nodes, tag);
    }
    done += static_cast<std::size_t>(here);
  }
  if (done != count)
  {
    cursor_.fail("declares " + std::to_string(count) + " elements, but its blocks hold " +
                 std::to_string(done));
  }
}

}  // namespace soft_tissue
