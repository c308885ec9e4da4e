#pragma once

#include <cstddef>
#include <vector>

#include "mesh_builder.h"

namespace soft_tissue
{
/** Cells as both VTK formats store them. */
struct VtkCells
{
  std::vector<long long> connectivity;  ///< node indices of all cells, one after the other
  std::vector<long long> ends;          ///< per cell, where its nodes end in `connectivity`
  std::vector<std::size_t> positions;   ///< per entry of `connectivity`, its place in the file
  std::vector<int> types;               ///< per cell, VTK's cell type
};

/** Adds all cells to the mesh. @throws Error at the cell's place in the file on bad cells */
void addVtkCells(FileCursor& cursor, const VtkCells& cells, MeshBuilder& builder);

}  // namespace soft_tissue
