#include <cstdint>
#include <cstdlib>

#include "formats.h"
#include "gmsh_reader.h"

namespace soft_tissue
{
namespace
{
/** Nodes of Gmsh's element types 1 ... 31; 0 where there is none. */
constexpr int kNodesOfType[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
constexpr int kPoint = 15;
constexpr int kTriangle = 2;
constexpr int kQuadrangle = 3;
constexpr int kTetrahedron = 4;
constexpr int kQuadraticTetrahedron = 11;  // edges 01 12 02 03 23 13

/** Curves and surfaces of any order among Gmsh's types; the rest are volumes. */
bool isVolume(int type)
{
  constexpr int kFlat[] = {1, 2, 3, 8, 9, 10, 15, 16, 20, 21, 22, 23, 24, 25, 26, 27, 28};
  for (const int flat : kFlat)
  {
    if (type == flat)
    {
      return false;
    }
  }
  return true;
}
}  // namespace

LoadedMesh GmshReader::read()
{
  readHeader();
  while (!cursor_.atEnd())
  {
    const std::string name(cursor_.word("a section"));
    if (name.size() < 2 || name[0] != '$')
    {
      cursor_.fail("expected a section such as '$Nodes', found " + inQuotes(name));
    }
    if (readSection(name.substr(1)))
    {
      cursor_.expect(name == "$NOD"   ? "$ENDNOD"
                     : name == "$ELM" ? "$ENDELM"
                                      : "$End" + name.substr(1));
    }
    else
    {
      cursor_.skipPast("$End" + name.substr(1));
    }
  }
  cursor_.setMark(cursor_.position());
  if (!have_nodes_ || !have_elements_)
  {
    cursor_.fail(std::string("the file ends without ") + (have_nodes_ ? "elements" : "nodes"));
  }
  return builder_.finish();
}

void GmshReader::readHeader()
{
  if (cursor_.peek() == "$NOD")
  {
    builder_.setFormat("gmsh 1 ascii");
    return;
  }
  cursor_.expect("$MeshFormat");
  const double number = cursor_.real("the format version");
  if (!(number >= 2.0 && number < 3.0) && number != 4.1)
  {
    cursor_.fail("Gmsh format version " + decimal(number) +
                 " is not supported, must be 1, 2.x or 4.1");
  }
  version_ = number < 3.0 ? 2 : 4;
  binary_ = cursor_.integer("the file type", 0, 1) == 1;
  cursor_.integer("the data size", 8, 8);
  if (binary_)
  {
    cursor_.endLine();
    cursor_.setBinary(true, false);
    if (cursor_.raw<std::int32_t>("the byte-order mark") != 1)
    {
      cursor_.seek(cursor_.position() - 4);
      cursor_.setBinary(true, true);
      if (cursor_.raw<std::int32_t>("the byte-order mark") != 1)
      {
        cursor_.fail("the byte-order mark is not 1 in either byte order");
      }
    }
  }
  cursor_.expect("$EndMeshFormat");
  builder_.setFormat("gmsh " + decimal(number) + (binary_ ? " binary" : " ascii"));
}

bool GmshReader::readSection(std::string_view name)
{
  const bool is_nodes = name == "Nodes" || name == "NOD";
  const bool is_elements = name == "Elements" || name == "ELM";
  if (is_nodes)
  {
    if (have_nodes_)
    {
      cursor_.fail("a second section of nodes");
    }
    have_nodes_ = true;
    version_ == 4 ? readNodes4() : readFlatNodes();
  }
  else if (is_elements)
  {
    if (!have_nodes_ || have_elements_)
    {
      cursor_.fail(have_nodes_ ? "a second section of elements" : "elements before the nodes");
    }
    have_elements_ = true;
    version_ == 4   ? readElements4()
    : version_ == 1 ? readElements1()
    : binary_       ? readElements2Binary()
                    : readElements2();
  }
  else if (name == "Entities" && version_ == 4)
  {
    readEntities4();
  }
  else
  {
    return false;
  }
  return true;
}

void GmshReader::addNode(long long number, double x, double y, double z)
{
  if (!index_of_.emplace(number, static_cast<long long>(builder_.nodeCount())).second)
  {
    cursor_.fail("node number " + std::to_string(number) + " is used twice");
  }
  builder_.addNode(x, y, z);
}

int GmshReader::nodesOfType(long long type) const
{
  if (type < 1 || type > 31)
  {
    cursor_.fail("element type " + std::to_string(type) + " is not known, must be in [1, 31]");
  }
  return kNodesOfType[type];
}

void GmshReader::addElement(int type, const std::vector<long long>& numbers, int tag)
{
  std::vector<long long> nodes;
  for (const long long number : numbers)
  {
    const auto found = index_of_.find(number);
    if (found == index_of_.end())
    {
      cursor_.fail("an element names node " + std::to_string(number) + ", which does not exist");
    }
    nodes.push_back(found->second);
  }
  if (type == kTetrahedron)
  {
    builder_.addTet({nodes[0], nodes[1], nodes[2], nodes[3]}, tag);
  }
  else if (type == kQuadraticTetrahedron)
  {
    builder_.addQuadraticTet({nodes[0], nodes[1], nodes[2], nodes[3], nodes[4], nodes[6], nodes[7],
                              nodes[5], nodes[9], nodes[8]},
                             tag);
  }
  else if (type == kTriangle || type == kQuadrangle)
  {
    builder_.addPolygon(nodes);
  }
  else if (isVolume(type))
  {
    builder_.refuseVolumeElement("Gmsh type " + std::to_string(type));
  }
  else
  {
    builder_.addOther();
  }
}

void GmshReader::readFlatNodes()
{
  const long long declared = cursor_.integer("the number of nodes", 0, INT64_MAX);
  const std::size_t count = cursor_.checkedCount(declared, binary_ ? 28 : 8, "nodes");
  if (binary_)
  {
    cursor_.endLine();
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    const long long number = cursor_.value<std::int32_t>("a node number");
    const double x = cursor_.value<double>("a node's x");
    const double y = cursor_.value<double>("a node's y");
    const double z = cursor_.value<double>("a node's z");
    addNode(number, x, y, z);
  }
}

void GmshReader::readElements1()
{
  const long long declared = cursor_.integer("the number of elements", 0, INT64_MAX);
  const std::size_t count = cursor_.checkedCount(declared, 12, "elements");
  std::vector<long long> nodes;
  for (std::size_t i = 0; i < count; ++i)
  {
    cursor_.value<std::int32_t>("an element number");
    const int type = cursor_.value<std::int32_t>("an element type");
    const int physical = cursor_.value<std::int32_t>("a physical tag");
    const int elementary = cursor_.value<std::int32_t>("an elementary tag");
    nodes.resize(nodesOfType(type));
    const auto node_count = static_cast<long long>(nodes.size());
    cursor_.integer("the element's number of nodes", node_count, node_count);
    for (long long& node : nodes)
    {
      node = cursor_.value<std::int32_t>("an element's node");
    }
    addElement(type, nodes, physical != 0 ? physical : elementary);
  }
}

void GmshReader::readElements2()
{
  const long long declared = cursor_.integer("the number of elements", 0, INT64_MAX);
  const std::size_t count = cursor_.checkedCount(declared, 8, "elements");
  std::vector<long long> nodes;
  for (std::size_t i = 0; i < count; ++i)
  {
    cursor_.value<std::int32_t>("an element number");
    const int type = cursor_.value<std::int32_t>("an element type");
    nodes.resize(nodesOfType(type));
    const long long tag_count = cursor_.integer("the number of tags", 0, 1000);
    int tags[2] = {0, 0};
    for (long long k = 0; k < tag_count; ++k)
    {
      const int tag = cursor_.value<std::int32_t>("a tag");
      tags[k < 2 ? k : 1] = k < 2 ? tag : tags[1];
    }
    for (long long& node : nodes)
    {
      node = cursor_.value<std::int32_t>("an element's node");
    }
    addElement(type, nodes, tags[0] != 0 ? tags[0] : tags[1]);
  }
}

void GmshReader::readElements2Binary()
{
  const long long declared = cursor_.integer("the number of elements", 0, INT64_MAX);
  const std::size_t count = cursor_.checkedCount(declared, 8, "elements");
  cursor_.endLine();
  std::vector<long long> nodes;
  for (std::size_t done = 0; done < count;)
  {
    const int type = cursor_.raw<std::int32_t>("an element type");
    nodes.resize(nodesOfType(type));
    const int block = cursor_.raw<std::int32_t>("a block's number of elements");
    const int tag_count = cursor_.raw<std::int32_t>("the number of tags");
    if (block < 1 || static_cast<std::size_t>(block) > count - done || tag_count < 0 ||
        tag_count > 1000)
    {
      cursor_.fail("a block of " + std::to_string(block) + " elements with " +
                   std::to_string(tag_count) + " tags, where " + std::to_string(count - done) +
                   " elements are left");
    }
    for (int i = 0; i < block; ++i)
    {
      cursor_.raw<std::int32_t>("an element number");
      int tags[2] = {0, 0};
      for (int k = 0; k < tag_count; ++k)
      {
        const int tag = cursor_.raw<std::int32_t>("a tag");
        tags[k < 2 ? k : 1] = k < 2 ? tag : tags[1];
      }
      for (long long& node : nodes)
      {
        node = cursor_.raw<std::int32_t>("an element's node");
      }
      addElement(type, nodes, tags[0] != 0 ? tags[0] : tags[1]);
    }
    done += block;
  }
}

LoadedMesh readGmsh(FileCursor& cursor, double metres_per_unit)
{
  return GmshReader(cursor, metres_per_unit).read();
}

}  // namespace soft_tissue
