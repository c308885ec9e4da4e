#include "membrane_patches.h"

#include <algorithm>

#include "soft_tissue_sim/mesh/grouping.h"

namespace soft_tissue
{
namespace
{
/** Place of a node in a patch's triangle. */
int corner(const MembranePatch& patch, Index node)
{
  return static_cast<int>(std::find(patch.nodes.begin(), patch.nodes.begin() + 2, node) -
                          patch.nodes.begin());
}
}  // namespace

MembranePatches findPatches(Index node_count, const std::vector<Triangle>& triangles)
{
  MembranePatches mesh;
  for (const Triangle& t : triangles)
  {
    mesh.patches.push_back({{t[0], t[1], t[2], -1, -1, -1}, {-1, -1, -1}, {}, {1, 1, 1}});
  }
  const Adjacency groups = groupTriangleEdges(node_count, triangles);
  for (Index group = 0; group < groups.size(); ++group)
  {
    const Index* half = groups.begin(group);
    if (groups.end(group) - half != 2)
    {
      continue;
    }
    MembraneAngle angle;
    for (int side = 0; side < 2; ++side)
    {
      const int edge = half[side] % 3;
      const Triangle& t = triangles[half[side] / 3];
      angle.triangles[side] = half[side] / 3;
      angle.edges[side] = edge;
      angle.nodes[2 + side] = t[(edge + 2) % 3];
      if (side == 0)
      {
        angle.nodes[0] = t[edge];
        angle.nodes[1] = t[(edge + 1) % 3];
      }
    }
    for (int side = 0; side < 2; ++side)
    {
      MembranePatch& patch = mesh.patches[angle.triangles[side]];
      const int edge = angle.edges[side], own = (edge + 2) % 3, across = 3 + edge;
      const int a = corner(patch, angle.nodes[0]), b = corner(patch, angle.nodes[1]);
      patch.nodes[across] = angle.nodes[3 - side];
      patch.angles[edge] = static_cast<Index>(mesh.angles.size());
      patch.places[edge] = {a, b, side == 0 ? own : across, side == 0 ? across : own};
      // The second triangle's normal is on the first one's side if its edge runs the other way.
      patch.sides[edge] = (side == 0 || a == (edge + 1) % 3) ? 1 : -1;
    }
    mesh.angles.push_back(angle);
  }
  return mesh;
}

Adjacency membraneNeighbours(Index node_count, const std::vector<Triangle>& triangles)
{
  std::vector<Edge> pairs;
  for (const MembranePatch& patch : findPatches(node_count, triangles).patches)
  {
    for (const Index a : patch.nodes)
    {
      for (const Index b : patch.nodes)
      {
        if (a != b && a >= 0 && b >= 0)
        {
          pairs.push_back({a, b});
        }
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Adjacency rows;
  rows.offsets.assign(static_cast<std::size_t>(node_count) + 1, 0);
  for (const Edge& pair : pairs)
  {
    ++rows.offsets[pair[0] + 1];
    rows.items.push_back(pair[1]);
  }
  for (Index i = 0; i < node_count; ++i)
  {
    rows.offsets[i + 1] += rows.offsets[i];
  }
  return rows;
}

}  // namespace soft_tissue
