#include <cstdint>
#include <string>
#include <vector>

#include "formats.h"
#include "mesh_builder.h"

namespace soft_tissue
{
namespace
{
struct PlyProperty
{
  std::string name;
  std::string type;
  std::string count_type;  ///< empty unless the property is a list
};

struct PlyElement
{
  std::string name;
  long long count = 0;
  std::size_t position = 0;  ///< of its line in the header
  std::vector<PlyProperty> properties;

  int find(const std::string& property) const
  {
    for (std::size_t i = 0; i < properties.size(); ++i)
    {
      if (properties[i].name == property)
      {
        return static_cast<int>(i);
      }
    }
    return -1;
  }
};

std::size_t bytesOf(const std::string& type)
{
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8")
  {
    return 1;
  }
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16")
  {
    return 2;
  }
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32" || type == "float" ||
      type == "float32")
  {
    return 4;
  }
  return type == "double" || type == "float64" ? 8 : 0;
}

/** Reads PLY surfaces, and tet meshes in a "3d_element" list as OpenSurgSim writes them. */
class PlyReader
{
 public:
  PlyReader(FileCursor& cursor, double metres_per_unit)
      : cursor_(cursor), builder_(cursor, metres_per_unit)
  {}

  LoadedMesh read();

 private:
  void readHeader();
  void readFormat(const std::vector<std::string_view>& words);
  void readHeaderLine(const std::vector<std::string_view>& words);
  void readProperty(const std::vector<std::string_view>& words);
  void readElement(const PlyElement& element);
  void readItem(const PlyElement& element);
  void checkVertexElement(const PlyElement& element) const;
  double number(const std::string& type, const char* what);
  long long wholeNumber(const std::string& type, const char* what);

  FileCursor& cursor_;
  MeshBuilder builder_;
  std::vector<PlyElement> elements_;
  std::vector<double> scalars_;   ///< of the current item, one per property
  std::vector<long long> nodes_;  ///< of the current item's vertex list
  bool little_endian_ = true;
  bool binary_ = false;
};

void PlyReader::readFormat(const std::vector<std::string_view>& words)
{
  const std::string_view encoding = words.size() == 3 ? words[1] : "";
  binary_ = encoding != "ascii";
  little_endian_ = encoding != "binary_big_endian";
  if (encoding != "ascii" && encoding != "binary_little_endian" && encoding != "binary_big_endian")
  {
    cursor_.fail("PLY format must be ascii, binary_little_endian or binary_big_endian");
  }
  builder_.setFormat(binary_ ? "ply binary" : "ply ascii");
}

void PlyReader::readProperty(const std::vector<std::string_view>& words)
{
  const bool list = words.size() == 5 && words[1] == "list";
  if ((!list && words.size() != 3) || elements_.empty())
  {
    cursor_.fail("the PLY property can't be read");
  }
  PlyProperty property;
  property.name = words.back();
  property.type = list ? words[3] : words[1];
  property.count_type = list ? words[2] : "";
  if (bytesOf(property.type) == 0 || (list && bytesOf(property.count_type) == 0))
  {
    cursor_.fail("PLY has no data type " + inQuotes(property.type));
  }
  elements_.back().properties.push_back(property);
}

void PlyReader::readHeaderLine(const std::vector<std::string_view>& words)
{
  if (words[0] == "format")
  {
    readFormat(words);
  }
  else if (words[0] == "element")
  {
    PlyElement element;
    if (words.size() != 3 || !parseInteger(words[2], element.count) || element.count < 0)
    {
      cursor_.fail("a PLY element needs a name and a count >= 0");
    }
    element.name = words[1];
    element.position = cursor_.mark();
    elements_.push_back(element);
  }
  else if (words[0] == "property")
  {
    readProperty(words);
  }
  else if (words[0] != "comment" && words[0] != "obj_info")
  {
    builder_.warn("header line " + inQuotes(words[0]) + " is no PLY keyword and was skipped");
  }
}

void PlyReader::readHeader()
{
  bool have_format = false;
  cursor_.expect("ply");
  cursor_.restOfLine();
  while (true)
  {
    if (cursor_.remaining() == 0)
    {
      cursor_.fail("the file ends inside the PLY header");
    }
    const std::vector<std::string_view> words = splitWords(cursor_.restOfLine());
    if (!words.empty() && words[0] == "end_header")
    {
      break;
    }
    if (!words.empty())
    {
      have_format = have_format || words[0] == "format";
      readHeaderLine(words);
    }
  }
  if (!have_format)
  {
    cursor_.fail("the PLY header has no format line");
  }
  cursor_.setBinary(binary_, little_endian_ != littleEndianMachine());
}

LoadedMesh PlyReader::read()
{
  readHeader();
  for (const PlyElement& element : elements_)
  {
    readElement(element);
  }
  if (!binary_ && !cursor_.atEnd())
  {
    cursor_.word("the end");
    cursor_.fail("the file holds more than its header declares");
  }
  return builder_.finish();
}

void PlyReader::checkVertexElement(const PlyElement& element) const
{
  for (const char* axis : {"x", "y", "z"})
  {
    const int place = element.find(axis);
    if (place < 0 || !element.properties[place].count_type.empty())
    {
      cursor_.fail(std::string("the PLY vertices have no property ") + axis);
    }
  }
}

void PlyReader::readElement(const PlyElement& element)
{
  const std::size_t begin = cursor_.position();
  cursor_.setMark(element.position);
  std::size_t smallest = 0;  // bytes of one item
  for (const PlyProperty& property : element.properties)
  {
    const bool list = !property.count_type.empty();
    smallest += binary_ ? bytesOf(list ? property.count_type : property.type) : 1;
  }
  cursor_.checkedCount(element.count, std::max<std::size_t>(smallest, 1), element.name.c_str());
  if (element.name == "vertex")
  {
    checkVertexElement(element);
  }
  cursor_.seek(begin);
  for (long long i = 0; i < element.count; ++i)
  {
    readItem(element);
  }
}

void PlyReader::readItem(const PlyElement& element)
{
  scalars_.assign(element.properties.size(), 0.0);
  nodes_.clear();
  bool have_nodes = false;
  for (std::size_t p = 0; p < element.properties.size(); ++p)
  {
    const PlyProperty& property = element.properties[p];
    if (property.count_type.empty())
    {
      scalars_[p] = number(property.type, property.name.c_str());
      continue;
    }
    const bool is_nodes = property.name == "vertex_indices" || property.name == "vertex_index";
    const std::size_t count =
        cursor_.checkedCount(wholeNumber(property.count_type, "a list's length"),
                             binary_ ? bytesOf(property.type) : 1, "list entries");
    for (std::size_t i = 0; i < count; ++i)
    {
      is_nodes ? nodes_.push_back(wholeNumber(property.type, "a node index"))
               : static_cast<void>(number(property.type, "a list entry"));
    }
    have_nodes = have_nodes || is_nodes;
  }
  if (element.name == "vertex")
  {
    builder_.addNode(scalars_[element.find("x")], scalars_[element.find("y")],
                     scalars_[element.find("z")]);
  }
  else if (element.name == "face" && have_nodes)
  {
    builder_.addPolygon(nodes_);
  }
  else if (element.name == "3d_element" && have_nodes)
  {
    if (nodes_.size() != 4)
    {
      cursor_.fail("a tet has " + std::to_string(nodes_.size()) + " nodes, must have 4");
    }
    builder_.addTet({nodes_[0], nodes_[1], nodes_[2], nodes_[3]}, 0);
  }
}

double PlyReader::number(const std::string& type, const char* what)
{
  if (type == "float" || type == "float32")
  {
    return cursor_.value<float>(what);
  }
  if (!binary_ || type == "double" || type == "float64")
  {
    return cursor_.value<double>(what);
  }
  return static_cast<double>(wholeNumber(type, what));
}

long long PlyReader::wholeNumber(const std::string& type, const char* what)
{
  const bool is_unsigned = type[0] == 'u';
  if (!binary_)
  {
    return cursor_.integer(what, is_unsigned ? 0 : INT32_MIN, UINT32_MAX);
  }
  switch (bytesOf(type))
  {
    case 1:
      return is_unsigned ? cursor_.raw<std::uint8_t>(what) : cursor_.raw<std::int8_t>(what);
    case 2:
      return is_unsigned ? cursor_.raw<std::uint16_t>(what) : cursor_.raw<std::int16_t>(what);
    default:
      if (type == "float" || type == "float32" || bytesOf(type) != 4)
      {
        cursor_.fail(std::string(what) + " has type " + inQuotes(type) + ", must be whole");
      }
      return is_unsigned ? static_cast<long long>(cursor_.raw<std::uint32_t>(what))
                         : cursor_.raw<std::int32_t>(what);
  }
}
}  // namespace

LoadedMesh readPly(FileCursor& cursor, double metres_per_unit)
{
  return PlyReader(cursor, metres_per_unit).read();
}

}  // namespace soft_tissue
