#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "formats.h"
#include "mesh_builder.h"

namespace soft_tissue
{
namespace
{
struct TetgenHeader
{
  long long count = 0;
  long long width = 0;  ///< dimension in a .node file, nodes of a tet in an .ele file
  long long attributes = 0;
  long long markers = 0;
};

TetgenHeader readHeader(FileCursor& cursor)
{
  cursor.atEnd();  // goes behind comments and blank lines
  TetgenHeader header;
  long long* const fields[] = {&header.count, &header.width, &header.attributes, &header.markers};
  std::string_view line = cursor.restOfLine();
  const std::vector<std::string_view> words = splitWords(line.substr(0, line.find('#')));
  if (words.size() < 2 || words.size() > 4)
  {
    cursor.fail("a TetGen header has 2 to 4 whole numbers, found " + inQuotes(line));
  }
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    if (!parseInteger(words[i], *fields[i]) || *fields[i] < 0 || (i >= 2 && *fields[i] > 1000))
    {
      cursor.fail("a TetGen header has 2 to 4 whole numbers >= 0, found " + inQuotes(line));
    }
  }
  return header;
}

/** Reads the nodes. @return the number of the first one, 0 or 1 */
long long readNodes(FileCursor& cursor, const TetgenHeader& header, MeshBuilder& builder)
{
  const std::size_t count = cursor.checkedCount(header.count, 7, "nodes");
  long long base = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto expected = base + static_cast<long long>(i);
    const long long number =
        cursor.integer("a node number", i == 0 ? 0 : expected, i == 0 ? 1 : expected);
    if (i == 0)
    {
      base = number;
      builder.setIndexBase(base);
    }
    const double x = cursor.real("a node's x");
    const double y = cursor.real("a node's y");
    const double z = cursor.real("a node's z");
    builder.addNode(x, y, z);
    for (long long k = 0; k < header.attributes + header.markers; ++k)
    {
      cursor.real("a node's attribute or marker");
    }
  }
  if (!cursor.atEnd())
  {
    cursor.word("the end");
    cursor.fail("the file holds more than the " + std::to_string(count) + " nodes it declares");
  }
  return base;
}

void readTets(FileCursor& cursor, const TetgenHeader& header, long long base, MeshBuilder& builder)
{
  const std::size_t count = cursor.checkedCount(header.count, 9, "tets");
  std::size_t fractional_tags = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto expected = base + static_cast<long long>(i);
    cursor.integer("a tet number", expected, expected);
    std::array<long long, 4> nodes;
    for (long long& node : nodes)
    {
      node = cursor.integer("a tet's node", INT32_MIN, INT32_MAX);
    }
    const std::size_t mark = cursor.mark();
    int tag = 0;
    for (long long k = 0; k < header.attributes; ++k)
    {
      const double attribute = cursor.real("a tet's attribute");
      if (k == 0 && std::abs(attribute) < 1.0e9 && attribute == std::floor(attribute))
      {
        tag = static_cast<int>(attribute);
      }
      else if (k == 0)
      {
        ++fractional_tags;
      }
    }
    cursor.setMark(mark);
    builder.addTet(nodes, tag);
  }
  if (fractional_tags > 0)
  {
    builder.warn(std::to_string(fractional_tags) +
                 " tets have an attribute that is no whole number; their tag is 0");
  }
  if (!cursor.atEnd())
  {
    cursor.word("the end");
    cursor.fail("the file holds more than the " + std::to_string(count) + " tets it declares");
  }
}

void checkHeader(FileCursor& cursor, const TetgenHeader& header, long long width, const char* what)
{
  if (header.width != width)
  {
    cursor.fail(std::string(what) + " = " + std::to_string(header.width) + ", must be " +
                std::to_string(width));
  }
}
}  // namespace

LoadedMesh readTetgen(FileCursor& cursor, double metres_per_unit)
{
  cursor.setComment('#');
  const TetgenHeader header = readHeader(cursor);
  const bool is_nodes = header.width == 3;
  if (!is_nodes)
  {
    checkHeader(cursor, header, 4, "nodes per tet (a .node file has 3 dimensions)");
  }
  const std::string partner =
      std::filesystem::path(cursor.path()).replace_extension(is_nodes ? ".ele" : ".node").string();
  FileCursor other(partner);
  other.setComment('#');
  const TetgenHeader other_header = readHeader(other);
  checkHeader(other, other_header, is_nodes ? 4 : 3, is_nodes ? "nodes per tet" : "dimensions");

  FileCursor& node_file = is_nodes ? cursor : other;
  FileCursor& tet_file = is_nodes ? other : cursor;
  MeshBuilder builder(node_file, metres_per_unit);
  builder.setFormat("tetgen ascii");
  const long long base = readNodes(node_file, is_nodes ? header : other_header, builder);
  builder.setCursor(tet_file);
  readTets(tet_file, is_nodes ? other_header : header, base, builder);
  return builder.finish();
}

}  // namespace soft_tissue
