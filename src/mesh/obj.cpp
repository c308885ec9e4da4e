#include <string>
#include <vector>

#include "formats.h"
#include "mesh_builder.h"

namespace soft_tissue
{
namespace
{
bool isIgnoredKeyword(std::string_view word)
{
  for (const char* known : {"vn", "vt", "vp", "g", "o", "s", "mtllib", "usemtl"})
  {
    if (word == known)
    {
      return true;
    }
  }
  return word[0] == '#';
}

void addVertex(FileCursor& cursor, const std::vector<std::string_view>& words, MeshBuilder& builder)
{
  double p[3] = {};
  if (words.size() < 4)
  {
    cursor.fail("a vertex needs three coordinates");
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!parseReal(words[axis + 1], p[axis]))
    {
      cursor.fail("a vertex's coordinate must be a number, found " + inQuotes(words[axis + 1]));
    }
  }
  builder.addNode(p[0], p[1], p[2]);
}

/** @param seen  vertices above this line, from which negative numbers count back */
void addFace(FileCursor& cursor, const std::vector<std::string_view>& words, long long seen,
             MeshBuilder& builder)
{
  std::vector<long long> nodes;
  for (std::size_t i = 1; i < words.size(); ++i)
  {
    long long number = 0;
    if (!parseInteger(words[i].substr(0, words[i].find('/')), number) || number == 0)
    {
      cursor.fail("a face's vertex number must be whole and not 0, found " + inQuotes(words[i]));
    }
    nodes.push_back(number > 0 ? number : seen + 1 + number);
  }
  builder.addPolygon(nodes);
}
}  // namespace

LoadedMesh readObj(FileCursor& cursor, double metres_per_unit)
{
  MeshBuilder builder(cursor, metres_per_unit, 1);
  builder.setFormat("obj");
  const std::size_t begin = cursor.position();
  while (cursor.remaining() > 0)
  {
    const std::vector<std::string_view> words = splitWords(cursor.restOfLine());
    if (!words.empty() && words[0] == "v")
    {
      addVertex(cursor, words, builder);
    }
  }
  cursor.seek(begin);
  long long seen = 0;
  while (cursor.remaining() > 0)
  {
    const std::vector<std::string_view> words = splitWords(cursor.restOfLine());
    if (words.empty() || isIgnoredKeyword(words[0]))
    {
      continue;
    }
    if (words[0] == "v")
    {
      ++seen;
    }
    else if (words[0] == "f")
    {
      addFace(cursor, words, seen, builder);
    }
    else if (words[0] == "l" || words[0] == "p")
    {
      builder.addOther();
    }
    else
    {
      cursor.fail("unexpected keyword " + inQuotes(words[0]));
    }
  }
  return builder.finish();
}

}  // namespace soft_tissue
