#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** A tetrahedral mesh in its rest state. */
struct TetMesh
{
  Points nodes;           ///< N x 3, metres
  std::vector<Tet> tets;  ///< M x 4, right handed
  std::vector<int> tags;  ///< M region tags as the file names them; 0 where it names none
};

/** A triangle mesh. */
struct TriMesh
{
  Points nodes;                     ///< N x 3, metres
  std::vector<Triangle> triangles;  ///< M x 3, counter-clockwise seen from outside
};

/** Six times the signed volume of a tetrahedron, m^3: positive when right handed. */
inline double signedVolume6(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return (b - a).cross(c - a).dot(d - a);
}

}  // namespace soft_tissue
