#pragma once

#include <string>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** A surface of flat triangles in place of a curved one. */
struct CadSurface
{
  TriMesh mesh;        ///< m, outward where it is closed
  std::string format;  ///< "STEP" or "IGES"
  std::size_t faces = 0;
  bool sewn = false;         ///< faces that only lay beside each other were joined at their edges
  bool turned = false;       ///< it was closed, but inside out
  double deviation_m = 0.0;  ///< largest distance found between a triangle and its face
  std::size_t samples = 0;   ///< points of triangles it was looked for at
};

/**
 * Reads the faces of a STEP or IGES file, NURBS among them, in the file's own unit of length, and
 * puts triangles in their place whose points are no farther than `chord_m` from them. That is
 * looked at between the corners, and triangles are made smaller until it holds.
 * @throws Error naming the file, if it can't be read, holds no faces or the bound can't be kept, or
 *         if this was built without OpenCASCADE
 */
CadSurface loadCadSurface(const std::string& path, double chord_m);

}  // namespace soft_tissue
