#pragma once

#include <string>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** How to fill a surface with tets. */
struct TetrahedralizeOptions
{
  std::string program = "tetgen";  ///< "tetgen" or "gmsh", run as a separate program
  double edge_length_m = 0.0;      ///< longest edge wanted; 0 leaves it to the surface
  double timeout_s = 600.0;        ///< the program is ended after this long
};

/**
 * Fills a closed surface with tets by running TetGen or Gmsh, found in PATH, in a temporary folder.
 *
 * TetGen keeps the surface's triangles and adds to them; Gmsh keeps them too, but builds the
 * surface anew if an edge length is given, which is the way to a mesh coarser than the surface.
 * @throws Error if the surface bounds no volume, the program is not installed, fails or takes too
 *         long; with the program's own words if it has any
 */
TetMesh tetrahedralize(const TriMesh& surface, const TetrahedralizeOptions& options);

}  // namespace soft_tissue
