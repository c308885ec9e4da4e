#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** A smooth function of a point, positive inside a shape. */
using LevelFunction = std::function<double(const Vec3&)>;

/** What a node of a mesh in the making must stay on, as bits. */
enum Constraint : std::uint8_t
{
  kOnSurface = 1,
  kOnNodule = 2,
  kOnBottom = 4,  ///< the plane z = 0
};

/** A tet mesh in the making. */
struct WorkMesh
{
  TetMesh mesh;
  std::vector<std::uint8_t> constraints;  ///< per node, Constraint bits
};

/**
 * Body-centred cubic lattice over a box: cube corners and centres, four tets around each cube face.
 * @param low          a cube corner
 * @param cells        cubes along each axis
 * @param flat_bottom  also fill the lowest half cells, so that the mesh ends in the plane z = low.z
 */
WorkMesh makeLattice(const Vec3& low, const std::array<int, 3>& cells, double cube_m,
                     bool flat_bottom);

/** Moves nodes close to the level's zero set onto it along the edges that cross it. */
void snapToLevel(WorkMesh& work, const LevelFunction& level, Constraint constraint);

/**
 * Cuts the tets along the level's zero set.
 * @param outside_tag  tag of the tets outside, or 0 to drop them
 * @param inside_tag   tag of the tets inside, or 0 to leave theirs
 */
void cutAtLevel(WorkMesh& work, const LevelFunction& level, Constraint constraint, int outside_tag,
                int inside_tag);

/** Numbers the nodes as the tets name them, drops the rest, and turns left-handed tets. */
void compact(WorkMesh& work);

/** Moves nodes, each within its constraints, while that makes the worst tet around them better. */
void improveShapes(WorkMesh& work, const LevelFunction& surface, const LevelFunction& nodule);

}  // namespace soft_tissue
