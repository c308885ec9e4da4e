#include "format_detection.h"

#include <cstdint>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
bool startsWith(std::string_view text, std::string_view start)
{
  return text.substr(0, start.size()) == start;
}

/** The size a binary STL file must have by its own count, or 0 if it is too short to tell. */
std::uint64_t binaryStlSize(std::string_view bytes)
{
  if (bytes.size() < 84)
  {
    return 0;
  }
  std::uint64_t triangles = 0;
  for (int i = 3; i >= 0; --i)
  {
    triangles = 256 * triangles + static_cast<unsigned char>(bytes[80 + i]);
  }
  return 84 + 50 * triangles;
}

/** Words of the first line that is neither blank nor a '#' comment. */
std::vector<std::string_view> firstWords(std::string_view bytes)
{
  std::size_t start = 0;
  while (start < bytes.size())
  {
    const std::size_t end = std::min(bytes.find('\n', start), bytes.size());
    std::vector<std::string_view> words = splitWords(bytes.substr(start, end - start));
    if (!words.empty() && words[0][0] != '#')
    {
      return words;
    }
    start = end + 1;
  }
  return {};
}

bool isTetgenHeader(const std::vector<std::string_view>& words)
{
  long long number = 0;
  for (const std::string_view word : words)
  {
    if (!parseInteger(word, number))
    {
      return false;
    }
  }
  return words.size() >= 2;
}

bool isObjKeyword(std::string_view word)
{
  for (const char* keyword :
       {"v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl"})
  {
    if (word == keyword)
    {
      return true;
    }
  }
  return false;
}
}  // namespace

MeshReader detectReader(const FileCursor& cursor)
{
  std::string_view bytes = cursor.bytes().substr(cursor.position());
  const std::uint64_t stl_size = binaryStlSize(bytes);
  if (stl_size == bytes.size())
  {
    return readBinaryStl;
  }
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const std::string_view text = first == std::string_view::npos ? bytes : bytes.substr(first);
  const std::vector<std::string_view> words = firstWords(text);
  const std::string_view word = words.empty() ? "" : words[0];
  if (startsWith(text, "$MeshFormat") || startsWith(text, "$NOD"))
  {
    return readGmsh;
  }
  if (startsWith(text, "# vtk DataFile"))
  {
    return readLegacyVtk;
  }
  if (startsWith(text, "<VTKFile") || startsWith(text, "<?xml"))
  {
    return readVtu;
  }
  if (word == "MeshVersionFormatted")
  {
    return readMedit;
  }
  if (word == "ply")
  {
    return readPly;
  }
  if (word == "solid")
  {
    return readAsciiStl;
  }
  if (isObjKeyword(word))
  {
    return readObj;
  }
  if (isTetgenHeader(words))
  {
    return readTetgen;
  }
  std::string reason =
      ": is in no known mesh format (Gmsh, VTK, VTU, TetGen, Medit, PLY, STL, OBJ)";
  if (stl_size != 0)
  {
    reason += "; a binary STL would have " + std::to_string(stl_size) +
              " bytes by its count at byte 80, it has " + std::to_string(bytes.size());
  }
  throw Error(cursor.path() + reason);
}

}  // namespace soft_tissue
