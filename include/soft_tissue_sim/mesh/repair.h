#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** What a repair did and what it could not do, a sentence each. */
struct RepairReport
{
  std::vector<std::string> done;
  std::vector<std::string> left;
};

/**
 * Merges nodes at the same place, drops tets with a repeated node, with no volume or with the nodes
 * of an earlier one, turns left-handed tets and drops nodes in no tet.
 * @throws Error if no tet is left
 */
RepairReport repairMesh(TetMesh& mesh);

/**
 * Merges nodes at the same place, drops triangles without area or with the nodes of an earlier one,
 * turns the rest to agree with their neighbours and to point out of the solid, drops unused nodes.
 *
 * A closed shell inside an odd number of others bounds a cavity and points into it.
 * @throws Error if no triangle is left
 */
RepairReport repairSurface(TriMesh& mesh);

}  // namespace soft_tissue
