#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** What a reader found beside the mesh itself; nothing in it is fatal, all of it is to be told. */
struct LoadReport
{
  std::string format;               ///< e.g. "gmsh 4.1 binary"
  std::size_t reoriented_tets = 0;  ///< left-handed tets whose winding was turned on load
  std::size_t ignored_elements =
      0;  ///< elements of other kinds (points, lines, triangles beside tets)
  std::vector<std::string> warnings;  ///< one sentence each
};

/** A tet mesh with the report of its reading. */
struct LoadedTetMesh
{
  TetMesh mesh;
  LoadReport report;
};

/** Whatever a file holds: a volume, or a surface if it has no tet (then the volume is empty). */
struct LoadedMesh
{
  TetMesh volume;
  TriMesh surface;
  LoadReport report;
};

/** A triangle mesh with the report of its reading. */
struct LoadedTriMesh
{
  TriMesh mesh;
  LoadReport report;
};

/**
 * Reads a tetrahedral mesh: Gmsh .msh 1 / 2.2 / 4.1 (ASCII, binary), legacy .vtk (ASCII, binary),
 * VTK XML .vtu (ASCII), TetGen .node/.ele, Medit .mesh, tetrahedral ASCII .ply.
 *
 * The format is told by the file's content, not its name. Left-handed tets are turned and counted
 * in the report. Quadratic tets of Gmsh and VTK files are read by their vertices; an Error if one
 * has an edge that is not straight.
 * @param path             file; for TetGen either the .node or the .ele file
 * @param metres_per_unit  length of one file unit in metres, > 0
 * @throws Error naming the file, the line or record, and the reason
 */
LoadedTetMesh loadTetMesh(const std::string& path, double metres_per_unit);

/**
 * Reads a triangle mesh: STL (ASCII, binary), OBJ, PLY (ASCII, binary), legacy .vtk POLYDATA.
 *
 * STL corners with bit-equal coordinates become one node; polygons are cut into triangle fans.
 * @param metres_per_unit  length of one file unit in metres, > 0
 * @throws Error naming the file, the line or record, and the reason
 */
LoadedTriMesh loadTriMesh(const std::string& path, double metres_per_unit);

/**
 * Reads any file loadTetMesh() or loadTriMesh() can read.
 * @param metres_per_unit  length of one file unit in metres, > 0
 * @throws Error naming the file, the line or record, and the reason
 */
LoadedMesh loadMesh(const std::string& path, double metres_per_unit);

/**
 * Writes Gmsh 2.2 ASCII in metres, the tags as physical and elementary tags.
 * @param digits  significant digits of the coordinates, 17 loses nothing
 * @throws Error if the file can't be written
 */
void saveGmsh(const std::string& path, const TetMesh& mesh, int digits = 17);

/** Writes binary STL in metres. @throws Error if the file can't be written */
void saveStl(const std::string& path, const TriMesh& mesh);

/** Metres per unit for "m", "cm", "mm" or "um". @throws Error for any other name */
double metresPerUnit(const std::string& unit);

}  // namespace soft_tissue
