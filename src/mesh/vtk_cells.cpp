#include "vtk_cells.h"

#include <string>

namespace soft_tissue
{
namespace
{
enum VtkType
{
  kVertex = 1,
  kPolyVertex = 2,
  kLine = 3,
  kPolyLine = 4,
  kTriangle = 5,
  kTriangleStrip = 6,
  kPolygon = 7,
  kPixel = 8,
  kQuad = 9,
  kTetra = 10,
  kQuadraticEdge = 21,
  kQuadraticTriangle = 22,
  kQuadraticTetra = 24,  // edges 01 12 02 03 13 23
};

void needNodes(FileCursor& cursor, std::size_t found, std::size_t needed)
{
  if (found != needed)
  {
    cursor.fail("a cell has " + std::to_string(found) + " nodes, its type needs " +
                std::to_string(needed));
  }
}

void addVtkCell(FileCursor& cursor, int type, const std::vector<long long>& nodes,
                MeshBuilder& builder)
{
  switch (type)
  {
    case kVertex:
    case kPolyVertex:
    case kLine:
    case kPolyLine:
    case kQuadraticEdge:
    case kQuadraticTriangle:
      builder.addOther();
      return;
    case kTriangle:
      needNodes(cursor, nodes.size(), 3);
      builder.addPolygon(nodes);
      return;
    case kTriangleStrip:
      for (std::size_t i = 2; i < nodes.size(); ++i)
      {
        builder.addPolygon({nodes[i - 2 + i % 2], nodes[i - 1 - i % 2], nodes[i]});
      }
      return;
    case kPixel:
      needNodes(cursor, nodes.size(), 4);
      builder.addPolygon({nodes[0], nodes[1], nodes[3], nodes[2]});
      return;
    case kQuad:
      needNodes(cursor, nodes.size(), 4);
      builder.addPolygon(nodes);
      return;
    case kPolygon:
      builder.addPolygon(nodes);
      return;
    case kTetra:
      needNodes(cursor, nodes.size(), 4);
      builder.addTet({nodes[0], nodes[1], nodes[2], nodes[3]}, 0);
      return;
    case kQuadraticTetra:
      needNodes(cursor, nodes.size(), 10);
      builder.addQuadraticTet({nodes[0], nodes[1], nodes[2], nodes[3], nodes[4], nodes[6], nodes[7],
                               nodes[5], nodes[8], nodes[9]},
                              0);
      return;
    default:
      builder.refuseVolumeElement("VTK type " + std::to_string(type));
  }
}
}  // namespace

void addVtkCells(FileCursor& cursor, const VtkCells& cells, MeshBuilder& builder)
{
  if (cells.ends.size() != cells.types.size())
  {
    cursor.fail("declares " + std::to_string(cells.ends.size()) + " cells, but " +
                std::to_string(cells.types.size()) + " cell types");
  }
  const auto size = static_cast<long long>(cells.connectivity.size());
  if ((cells.ends.empty() ? 0 : cells.ends.back()) != size)
  {
    cursor.fail("the cells end at entry " +
                std::to_string(cells.ends.empty() ? 0 : cells.ends.back()) +
                " of the connectivity, which has " + std::to_string(size));
  }
  std::vector<long long> nodes;
  long long begin = 0;
  for (std::size_t cell = 0; cell < cells.ends.size(); ++cell)
  {
    const long long end = cells.ends[cell];
    if (end <= begin || end > size)
    {
      cursor.fail("cell " + std::to_string(cell) + " ends at entry " + std::to_string(end) +
                  " of the connectivity, must be in [" + std::to_string(begin + 1) + ", " +
                  std::to_string(size) + "]");
    }
    nodes.assign(cells.connectivity.begin() + begin, cells.connectivity.begin() + end);
    cursor.setMark(cells.positions[begin]);
    addVtkCell(cursor, cells.types[cell], nodes, builder);
    begin = end;
  }
}

}  // namespace soft_tissue
