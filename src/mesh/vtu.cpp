#include <cstdint>
#include <string>

#include "formats.h"
#include "vtk_cells.h"
#include "xml_tag.h"

namespace soft_tissue
{
namespace
{
/** Reads VTK XML unstructured grids of one ASCII piece. */
class VtuReader
{
 public:
  VtuReader(FileCursor& cursor, double metres_per_unit)
      : cursor_(cursor), builder_(cursor, metres_per_unit)
  {
    cursor_.setWordBreak('<');
  }

  LoadedMesh read();

 private:
  void readTag(const XmlTag& tag);
  void readPiece(const XmlTag& tag);
  void readArray(const XmlTag& tag);
  void readPoints(const XmlTag& tag);
  void readConnectivity();
  std::size_t attributeCount(const XmlTag& tag, const char* key);
  bool arrayEnds() { return cursor_.peek().substr(0, 1) == "<"; }
  /** @throws Error unless the array is over */
  void endArray(const char* what, std::size_t expected);

  FileCursor& cursor_;
  MeshBuilder builder_;
  VtkCells cells_;
  std::string section_;
  std::size_t points_ = 0;
  std::size_t cell_count_ = 0;
  bool have_piece_ = false;
  bool have_cells_ = false;
  bool closed_ = false;
};

LoadedMesh VtuReader::read()
{
  builder_.setFormat("vtu ascii");
  XmlTag tag;
  while (!closed_ && nextXmlTag(cursor_, tag))
  {
    readTag(tag);
  }
  cursor_.setMark(cursor_.position());
  if (!closed_)
  {
    cursor_.fail("the file ends before '</VTKFile>'");
  }
  if (!have_cells_)
  {
    cursor_.fail("the file has no <Cells>");
  }
  return builder_.finish();
}

void VtuReader::readTag(const XmlTag& tag)
{
  if (tag.name == "VTKFile" && tag.attribute("type") != "UnstructuredGrid")
  {
    cursor_.fail("VTK file type " + inQuotes(tag.attribute("type")) + ", must be UnstructuredGrid");
  }
  else if (tag.name == "Piece")
  {
    readPiece(tag);
  }
  else if (tag.name == "AppendedData")
  {
    cursor_.fail("appended data can't be read; save the file as ASCII");
  }
  else if (tag.name == "DataArray")
  {
    readArray(tag);
  }
  else if (tag.name == "/Cells")
  {
    if (cells_.ends.size() != cell_count_)
    {
      cursor_.fail("<Cells> lacks its offsets");
    }
    addVtkCells(cursor_, cells_, builder_);
    have_cells_ = true;
  }
  else if (tag.name == "/VTKFile")
  {
    closed_ = true;
  }
  if (tag.name == "Points" || tag.name == "Cells" || tag.name == "PointData" ||
      tag.name == "CellData")
  {
    section_ = tag.name;
  }
}

std::size_t VtuReader::attributeCount(const XmlTag& tag, const char* key)
{
  long long value = 0;
  if (!parseInteger(tag.attribute(key), value))
  {
    cursor_.fail(std::string(key) + " must be a whole number, found " +
                 inQuotes(tag.attribute(key)));
  }
  return cursor_.checkedCount(value, 1, key);
}

void VtuReader::readPiece(const XmlTag& tag)
{
  if (have_piece_)
  {
    cursor_.fail("a second <Piece>; only files of one piece can be read");
  }
  have_piece_ = true;
  points_ = attributeCount(tag, "NumberOfPoints");
  cell_count_ = attributeCount(tag, "NumberOfCells");
}

void VtuReader::readArray(const XmlTag& tag)
{
  const std::string name = tag.attribute("Name");
  if (!have_piece_ || tag.self_closing || (section_ != "Points" && section_ != "Cells"))
  {
    return;
  }
  if (tag.attribute("format", "ascii") != "ascii")
  {
    cursor_.fail("data format " + inQuotes(tag.attribute("format")) +
                 " can't be read; save the file as ASCII");
  }
  if (section_ == "Points")
  {
    readPoints(tag);
  }
  else if (name == "connectivity")
  {
    readConnectivity();
  }
  else if (name == "offsets")
  {
    for (std::size_t i = 0; i < cell_count_; ++i)
    {
      cells_.ends.push_back(cursor_.integer("a cell's offset", 0, INT64_MAX));
    }
    endArray("offsets", cell_count_);
  }
  else if (name == "types")
  {
    for (std::size_t i = 0; i < cell_count_; ++i)
    {
      cells_.types.push_back(static_cast<int>(cursor_.integer("a cell's type", 0, 255)));
    }
    endArray("types", cell_count_);
  }
}

void VtuReader::readPoints(const XmlTag& tag)
{
  if (tag.attribute("NumberOfComponents") != "3" || builder_.nodeCount() != 0)
  {
    cursor_.fail("<Points> must hold one array of 3 components");
  }
  for (std::size_t i = 0; i < points_; ++i)
  {
    const double x = cursor_.real("a point's x");
    const double y = cursor_.real("a point's y");
    const double z = cursor_.real("a point's z");
    builder_.addNode(x, y, z);
  }
  endArray("points", points_);
}

void VtuReader::readConnectivity()
{
  while (!arrayEnds())
  {
    cells_.connectivity.push_back(cursor_.integer("a cell's node", 0, INT64_MAX));
    cells_.positions.push_back(cursor_.mark());
  }
}

void VtuReader::endArray(const char* what, std::size_t expected)
{
  if (!arrayEnds())
  {
    cursor_.word("the array's end");
    cursor_.fail(std::string("the array holds more than the ") + std::to_string(expected) + " " +
                 what + " that <Piece> declares");
  }
}
}  // namespace

LoadedMesh readVtu(FileCursor& cursor, double metres_per_unit)
{
  return VtuReader(cursor, metres_per_unit).read();
}

}  // namespace soft_tissue
