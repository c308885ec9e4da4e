#pragma once

#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** What a marching method needs to know of a body's connectivity; made once, renewed after a
 * topology change. */
struct FieldTopology
{
  const std::vector<Tet>* tets = nullptr;
  const BoundarySurface* surface = nullptr;
  const Adjacency* node_neighbours = nullptr;
};

/**
 * Depth inside a tet body on its nodes, by marching over the mesh itself.
 *
 * Source: [Marchal2004] closest-feature fast marching: nodes in order of distance, each handing its
 * closest boundary triangle on to its neighbours.
 */
class DistanceField
{
 public:
  virtual ~DistanceField() = default;

  /** Depth of every node at positions x (N x 3, m). @throws Error for another number of nodes */
  virtual void march(const Points& x) = 0;

  /** The same, stopped as soon as all `wanted` nodes have their depth. @throws Error for a bad
   * index */
  virtual void marchUntil(const Points& x, const std::vector<Index>& wanted) = 0;

  /** Nodal depths, m: 0 on the boundary, > 0 inside, NaN where not marched or not connected. */
  virtual const std::vector<double>& depth() const = 0;

  /** Per node the boundary triangle nearest to it (index into surface->triangles), -1 where not
   * marched. */
  virtual const std::vector<Index>& closestTriangle() const = 0;
};

/**
 * A field by name: "cffm". It keeps the pointers of the topology and takes all its memory here.
 * @throws Error naming the known methods, or if parts of the topology are missing or don't match
 */
std::unique_ptr<DistanceField> makeDistanceField(const std::string& method,
                                                 const FieldTopology& topology);

}  // namespace soft_tissue
