#include <cstdint>
#include <string>

#include "formats.h"
#include "vtk_cells.h"

namespace soft_tissue
{
namespace
{
constexpr int kPolygonType = 7;

/** Reads legacy VTK files, versions 2 to 5.1. */
class LegacyVtkReader
{
 public:
  LegacyVtkReader(FileCursor& cursor, double metres_per_unit)
      : cursor_(cursor), builder_(cursor, metres_per_unit)
  {}

  LoadedMesh read();

 private:
  void readHeader();
  /** @return false at the data that belongs to no mesh, which ends the reading */
  bool readBlock(const std::string& keyword);
  void readPoints();
  void readCells(int type);
  void readSizedCells(std::size_t count, long long size, int type);
  void readOffsetCells(long long offset_count, long long size, int type);
  void readTypes();
  void skipField();
  double number(const std::string& type, const char* what);
  std::size_t bytesOf(const std::string& type);
  long long declared(const char* what) { return cursor_.integer(what, 0, INT64_MAX); }
  void startData()
  {
    if (cursor_.binary())
    {
      cursor_.endLine();
    }
  }

  FileCursor& cursor_;
  MeshBuilder builder_;
  VtkCells cells_;
  bool grid_ = false;
  bool have_points_ = false;
  bool have_types_ = false;
  double version_ = 0.0;
};

void LegacyVtkReader::readHeader()
{
  cursor_.expect("#");
  cursor_.expect("vtk");
  cursor_.expect("DataFile");
  cursor_.expect("Version");
  version_ = cursor_.real("the format version");
  if (!(version_ >= 1.0 && version_ < 6.0))
  {
    cursor_.fail("legacy VTK version " + decimal(version_) + ", must be in [1, 6)");
  }
  cursor_.restOfLine();
  cursor_.restOfLine();
  const std::string encoding(cursor_.word("ASCII or BINARY"));
  if (encoding != "ASCII" && encoding != "BINARY")
  {
    cursor_.fail("expected ASCII or BINARY, found " + inQuotes(encoding));
  }
  if (encoding == "BINARY")
  {
    cursor_.setBinary(true, littleEndianMachine());  // legacy VTK stores the high byte first
  }
  cursor_.expect("DATASET");
  const std::string kind(cursor_.word("the kind of data set"));
  if (kind != "UNSTRUCTURED_GRID" && kind != "POLYDATA")
  {
    cursor_.fail("data set " + inQuotes(kind) + ", must be UNSTRUCTURED_GRID or POLYDATA");
  }
  grid_ = kind == "UNSTRUCTURED_GRID";
  builder_.setFormat("vtk " + decimal(version_) + (encoding == "ASCII" ? " ascii " : " binary ") +
                     kind);
}

LoadedMesh LegacyVtkReader::read()
{
  readHeader();
  while (!cursor_.atEnd() && readBlock(std::string(cursor_.word("a keyword"))))
  {}
  cursor_.setMark(cursor_.position());
  if (!have_points_ || (grid_ && !have_types_))
  {
    cursor_.fail(std::string("the data set has no ") + (have_points_ ? "CELL_TYPES" : "POINTS"));
  }
  addVtkCells(cursor_, cells_, builder_);
  return builder_.finish();
}

bool LegacyVtkReader::readBlock(const std::string& keyword)
{
  if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
  {
    return false;
  }
  if (keyword == "POINTS")
  {
    readPoints();
  }
  else if (keyword == "METADATA")
  {
    while (cursor_.remaining() > 0 && (cursor_.restOfLine(), cursor_.remaining() > 0) &&
           cursor_.bytes()[cursor_.position()] != '\n')
    {}
  }
  else if (keyword == "FIELD")
  {
    skipField();
  }
  else if (grid_ && keyword == "CELLS")
  {
    readCells(0);
  }
  else if (grid_ && keyword == "CELL_TYPES")
  {
    readTypes();
  }
  else if (!grid_ && keyword == "POLYGONS")
  {
    readCells(kPolygonType);
  }
  else if (!grid_ && keyword == "TRIANGLE_STRIPS")
  {
    readCells(6);
  }
  else if (!grid_ && (keyword == "LINES" || keyword == "VERTICES"))
  {
    readCells(keyword == "LINES" ? 4 : 2);
  }
  else
  {
    cursor_.fail("unexpected keyword " + inQuotes(keyword));
  }
  return true;
}

std::size_t LegacyVtkReader::bytesOf(const std::string& type)
{
  if (type == "char" || type == "unsigned_char")
  {
    return 1;
  }
  if (type == "short" || type == "unsigned_short")
  {
    return 2;
  }
  if (type == "int" || type == "unsigned_int" || type == "float" || type == "vtkIdType")
  {
    return 4;
  }
  if (type == "long" || type == "unsigned_long" || type == "double" || type == "vtktypeint64")
  {
    return 8;
  }
  cursor_.fail("data type " + inQuotes(type) + " is not supported");
}

double LegacyVtkReader::number(const std::string& type, const char* what)
{
  if (type == "float")
  {
    return cursor_.value<float>(what);
  }
  if (!cursor_.binary() || type == "double")
  {
    return cursor_.value<double>(what);
  }
  switch (bytesOf(type))
  {
    case 1:
      return cursor_.raw<std::int8_t>(what);
    case 2:
      return cursor_.raw<std::int16_t>(what);
    case 4:
      return cursor_.raw<std::int32_t>(what);
    default:
      return static_cast<double>(cursor_.raw<std::int64_t>(what));
  }
}

void LegacyVtkReader::readPoints()
{
  if (have_points_)
  {
    cursor_.fail("a second block of POINTS");
  }
  have_points_ = true;
  const long long count = declared("the number of points");
  const std::string type(cursor_.word("the points' data type"));
  const std::size_t bytes = bytesOf(type);
  startData();
  const std::size_t points =
      cursor_.checkedCount(count, cursor_.binary() ? 3 * bytes : 5, "points");
  for (std::size_t i = 0; i < points; ++i)
  {
    const double x = number(type, "a point's x");
    const double y = number(type, "a point's y");
    const double z = number(type, "a point's z");
    builder_.addNode(x, y, z);
  }
}

void LegacyVtkReader::readCells(int type)
{
  if (!have_points_)
  {
    cursor_.fail("cells before the POINTS");
  }
  const long long first = declared("the number of cells");
  const long long second = declared("the size of the cells");
  startData();
  if (cursor_.peek() == "OFFSETS" && version_ >= 5.0)
  {
    readOffsetCells(first, second, type);
    return;
  }
  cursor_.setMark(cursor_.position());
  readSizedCells(cursor_.checkedCount(first, cursor_.binary() ? 4 : 1, "cells"), second, type);
}

void LegacyVtkReader::readSizedCells(std::size_t count, long long size, int type)
{
  cursor_.checkedCount(size, cursor_.binary() ? 4 : 1, "cell entries");
  long long left = size;
  for (std::size_t cell = 0; cell < count; ++cell)
  {
    const long long nodes = cursor_.value<std::int32_t>("a cell's number of nodes");
    if (nodes < 1 || nodes > left - 1)
    {
      cursor_.fail("cell " + std::to_string(cell) + " has " + std::to_string(nodes) +
                   " nodes, must be in [1, " + std::to_string(left - 1) + "]");
    }
    left -= nodes + 1;
    for (long long i = 0; i < nodes; ++i)
    {
      cells_.connectivity.push_back(cursor_.value<std::int32_t>("a cell's node"));
      cells_.positions.push_back(cursor_.mark());
    }
    cells_.ends.push_back(static_cast<long long>(cells_.connectivity.size()));
    if (!grid_)
    {
      cells_.types.push_back(type);
    }
  }
  if (left != 0)
  {
    cursor_.fail("the cells declare " + std::to_string(size) + " entries, " + std::to_string(left) +
                 " more than they have");
  }
}

void LegacyVtkReader::readOffsetCells(long long offset_count, long long size, int type)
{
  cursor_.expect("OFFSETS");
  const std::string offset_type(cursor_.word("the offsets' data type"));
  const std::size_t offset_bytes = cursor_.binary() ? bytesOf(offset_type) : 1;
  startData();
  const std::size_t count = cursor_.checkedCount(offset_count, offset_bytes, "offsets");
  const auto base = static_cast<long long>(cells_.connectivity.size());
  for (std::size_t i = 0; i < count; ++i)
  {
    const double offset = number(offset_type, "an offset");
    if (!(offset >= 0.0 && offset <= static_cast<double>(size)) || (i == 0 && offset != 0.0))
    {
      cursor_.fail("offset " + decimal(offset) + ", must start at 0 and be in [0, " +
                   std::to_string(size) + "]");
    }
    if (i > 0)
    {
      cells_.ends.push_back(base + static_cast<long long>(offset));
      if (!grid_)
      {
        cells_.types.push_back(type);
      }
    }
  }
  cursor_.expect("CONNECTIVITY");
  const std::string type_name(cursor_.word("the connectivity's data type"));
  const std::size_t bytes = cursor_.binary() ? bytesOf(type_name) : 1;
  startData();
  const std::size_t entries = cursor_.checkedCount(size, bytes, "cell entries");
  for (std::size_t i = 0; i < entries; ++i)
  {
    const double node = number(type_name, "a cell's node");
    if (!(node >= 0.0 && node < static_cast<double>(builder_.nodeCount())))
    {
      cursor_.fail("node " + decimal(node) + " does not exist");
    }
    cells_.connectivity.push_back(static_cast<long long>(node));
    cells_.positions.push_back(cursor_.mark());
  }
}

void LegacyVtkReader::readTypes()
{
  have_types_ = true;
  const long long count = declared("the number of cell types");
  startData();
  const std::size_t types = cursor_.checkedCount(count, cursor_.binary() ? 4 : 1, "cell types");
  for (std::size_t i = 0; i < types; ++i)
  {
    cells_.types.push_back(cursor_.value<std::int32_t>("a cell type"));
  }
}

void LegacyVtkReader::skipField()
{
  cursor_.word("the field's name");
  const long long arrays = cursor_.integer("the number of field arrays", 0, 1000);
  for (long long a = 0; a < arrays; ++a)
  {
    cursor_.word("an array's name");
    const long long components = cursor_.integer("the number of components", 0, 1 << 20);
    const long long tuples = cursor_.integer("the number of tuples", 0, 1 << 30);
    const std::string type(cursor_.word("the array's data type"));
    const std::size_t bytes = cursor_.binary() ? bytesOf(type) : 1;
    startData();
    const std::size_t entries = cursor_.checkedCount(components * tuples, bytes, "field entries");
    for (std::size_t i = 0; i < entries; ++i)
    {
      number(type, "a field entry");
    }
  }
}
}  // namespace

LoadedMesh readLegacyVtk(FileCursor& cursor, double metres_per_unit)
{
  return LegacyVtkReader(cursor, metres_per_unit).read();
}

}  // namespace soft_tissue
