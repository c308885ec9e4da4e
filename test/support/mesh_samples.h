#pragma once

#include <random>
#include <set>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::test
{
/** One right-handed tetrahedron on the unit axes. */
inline TetMesh unitTet()
{
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {0}};
}

/** Two right-handed tets that share the face (1, 2, 3), tags 1 and 2. */
inline TetMesh twoTets()
{
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
          {{0, 1, 2, 3}, {1, 2, 3, 4}},
          {1, 2}};
}

/** The surface of unitTet(), outward. */
inline TriMesh unitTetSurface()
{
  return {unitTet().nodes, {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
}

/** Random connectivity without geometry: `count` tets of four distinct nodes, any faces shared by
 * any number. */
inline std::vector<Tet> randomTets(Index node_count, int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<Tet> tets;
  while (static_cast<int>(tets.size()) < count)
  {
    Tet tet;
    for (Index& node : tet)
    {
      node = static_cast<Index>(random() % node_count);
    }
    if (std::set<Index>(tet.begin(), tet.end()).size() == 4)
    {
      tets.push_back(tet);
    }
  }
  return tets;
}

}  // namespace soft_tissue::test
