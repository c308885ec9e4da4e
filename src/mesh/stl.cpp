#include <cstdint>
#include <string>
#include <unordered_map>

#include "formats.h"
#include "mesh_builder.h"

namespace soft_tissue
{
namespace
{
struct CornerHash
{
  std::size_t operator()(const std::array<double, 3>& corner) const
  {
    std::size_t hash = 0;
    for (const double x : corner)
    {
      hash = hash * 1000003U + std::hash<double>()(x);
    }
    return hash;
  }
};

/** Turns corners into nodes: equal coordinates are one node. */
class CornerMerger
{
 public:
  explicit CornerMerger(MeshBuilder& builder) : builder_(builder) {}

  long long node(double x, double y, double z)
  {
    const auto next = static_cast<long long>(builder_.nodeCount());
    const auto [place, is_new] = nodes_.try_emplace({x, y, z}, next);
    if (is_new)
    {
      builder_.addNode(x, y, z);
    }
    return place->second;
  }

 private:
  MeshBuilder& builder_;
  std::unordered_map<std::array<double, 3>, long long, CornerHash> nodes_;
};

void readFacet(FileCursor& cursor, CornerMerger& merger, MeshBuilder& builder)
{
  cursor.expect("normal");
  for (int axis = 0; axis < 3; ++axis)
  {
    cursor.real("a normal");
  }
  cursor.expect("outer");
  cursor.expect("loop");
  std::vector<long long> nodes;
  for (int corner = 0; corner < 3; ++corner)
  {
    cursor.expect("vertex");
    const double x = cursor.real("a corner's x");
    const double y = cursor.real("a corner's y");
    const double z = cursor.real("a corner's z");
    nodes.push_back(merger.node(x, y, z));
  }
  cursor.expect("endloop");
  cursor.expect("endfacet");
  builder.addPolygon(nodes);
}
}  // namespace

LoadedMesh readAsciiStl(FileCursor& cursor, double metres_per_unit)
{
  MeshBuilder builder(cursor, metres_per_unit);
  builder.setFormat("stl ascii");
  CornerMerger merger(builder);
  while (!cursor.atEnd())
  {
    cursor.expect("solid");
    cursor.restOfLine();
    std::string_view keyword = cursor.word("'facet' or 'endsolid'");
    while (keyword != "endsolid")
    {
      if (keyword != "facet")
      {
        cursor.fail("expected 'facet' or 'endsolid', found " + inQuotes(keyword));
      }
      readFacet(cursor, merger, builder);
      keyword = cursor.word("'facet' or 'endsolid'");
    }
    cursor.restOfLine();
  }
  return builder.finish();
}

LoadedMesh readBinaryStl(FileCursor& cursor, double metres_per_unit)
{
  MeshBuilder builder(cursor, metres_per_unit);
  builder.setFormat("stl binary");
  CornerMerger merger(builder);
  cursor.setBinary(true, !littleEndianMachine());
  cursor.skip(80, "the header");
  const auto count =
      cursor.checkedCount(cursor.raw<std::uint32_t>("the number of triangles"), 50, "triangles");
  std::vector<long long> nodes(3);
  for (std::size_t i = 0; i < count; ++i)
  {
    cursor.skip(12, "a normal");
    for (long long& node : nodes)
    {
      const double x = cursor.raw<float>("a corner's x");
      const double y = cursor.raw<float>("a corner's y");
      const double z = cursor.raw<float>("a corner's z");
      node = merger.node(x, y, z);
    }
    cursor.skip(2, "a triangle's attribute");
    builder.addPolygon(nodes);
  }
  return builder.finish();
}

}  // namespace soft_tissue
