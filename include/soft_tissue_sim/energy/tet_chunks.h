#pragma once

#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/**
 * The order tets are worked in: near ones together, in chunks that are coloured so that those of
 * one colour share no node. Chunks of a colour can add to the same arrays at once, and whatever the
 * number of threads each sum is made in the same order. Of a large body the first colour has its
 * eighths, as halvedParts() says, the next ones what is left of quarters and halves: the first half
 * of each colour's chunks stays on one side of the body.
 */
struct TetChunks
{
  std::vector<Index> tets;     ///< [group][lane]: a tet of the mesh, or -1 in lanes left over
  std::vector<Index> groups;   ///< chunk c: groups[c] ... groups[c + 1] - 1
  std::vector<Index> colours;  ///< colour k: chunks colours[k] ... colours[k + 1] - 1
};

TetChunks chunkTets(const TetMesh& mesh);

}  // namespace soft_tissue
