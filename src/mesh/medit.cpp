#include <cstdint>
#include <string>

#include "formats.h"
#include "mesh_builder.h"

namespace soft_tissue
{
namespace
{
/** Medit keywords that carry nothing we use, with the numbers in each of their entries. */
struct SkippedKeyword
{
  const char* name;
  int numbers;
};
constexpr SkippedKeyword kSkipped[] = {
    {"Corners", 1},       {"RequiredVertices", 1},  {"Ridges", 1},
    {"RequiredEdges", 1}, {"RequiredTriangles", 1}, {"NormalAtVertices", 2},
    {"Normals", 3},       {"TangentAtVertices", 2}, {"Tangents", 3}};

class MeditReader
{
 public:
  MeditReader(FileCursor& cursor, double metres_per_unit)
      : cursor_(cursor), builder_(cursor, metres_per_unit, 1)
  {
    cursor_.setComment('#');
  }

  LoadedMesh read();

 private:
  void readBlock(const std::string& keyword);
  void readVertices();
  std::array<long long, 4> readElement(int nodes);
  std::size_t count(std::size_t bytes_each)
  {
    return cursor_.checkedCount(cursor_.integer("a count", 0, INT64_MAX), bytes_each, "entries");
  }

  FileCursor& cursor_;
  MeshBuilder builder_;
  int tag_ = 0;
};

LoadedMesh MeditReader::read()
{
  builder_.setFormat("medit ascii");
  cursor_.expect("MeshVersionFormatted");
  cursor_.integer("the format version", 1, 4);
  cursor_.expect("Dimension");
  cursor_.integer("the dimension", 3, 3);
  std::string keyword;
  while ((keyword = cursor_.word("'End'")) != "End")
  {
    readBlock(keyword);
  }
  return builder_.finish();
}

/** Reads the nodes of an element and its reference, which becomes tag_. */
std::array<long long, 4> MeditReader::readElement(int nodes)
{
  std::array<long long, 4> result{};
  for (int i = 0; i < nodes; ++i)
  {
    result[i] = cursor_.integer("an element's node", INT32_MIN, INT32_MAX);
  }
  const std::size_t mark = cursor_.mark();
  tag_ = static_cast<int>(cursor_.integer("an element's reference", INT32_MIN, INT32_MAX));
  cursor_.setMark(mark);
  return result;
}

void MeditReader::readVertices()
{
  if (builder_.nodeCount() != 0)
  {
    cursor_.fail("a second block of Vertices");
  }
  const std::size_t vertices = count(7);
  for (std::size_t i = 0; i < vertices; ++i)
  {
    const double x = cursor_.real("a vertex's x");
    const double y = cursor_.real("a vertex's y");
    const double z = cursor_.real("a vertex's z");
    builder_.addNode(x, y, z);
    cursor_.real("a vertex's reference");
  }
}

void MeditReader::readBlock(const std::string& keyword)
{
  for (const SkippedKeyword& skipped : kSkipped)
  {
    if (keyword == skipped.name)
    {
      const std::size_t numbers = count(1) * skipped.numbers;
      for (std::size_t i = 0; i < numbers; ++i)
      {
        cursor_.real("an entry");
      }
      return;
    }
  }
  if (keyword == "Vertices")
  {
    readVertices();
    return;
  }
  const int nodes = keyword == "Edges"                                       ? 2
                    : keyword == "Triangles"                                 ? 3
                    : keyword == "Quadrilaterals" || keyword == "Tetrahedra" ? 4
                                                                             : 0;
  if (nodes == 0 && (keyword == "Hexahedra" || keyword == "Prisms" || keyword == "Pyramids"))
  {
    builder_.refuseVolumeElement(keyword);
  }
  if (nodes == 0)
  {
    cursor_.fail("unexpected keyword " + inQuotes(keyword));
  }
  const std::size_t elements = count(2 * nodes);
  for (std::size_t i = 0; i < elements; ++i)
  {
    const std::array<long long, 4> element = readElement(nodes);
    if (keyword == "Tetrahedra")
    {
      builder_.addTet(element, tag_);
    }
    else if (nodes == 2)
    {
      builder_.addOther();
    }
    else
    {
      builder_.addPolygon({element.begin(), element.begin() + nodes});
    }
  }
}
}  // namespace

LoadedMesh readMedit(FileCursor& cursor, double metres_per_unit)
{
  return MeditReader(cursor, metres_per_unit).read();
}

}  // namespace soft_tissue
