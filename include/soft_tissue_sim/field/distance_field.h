#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** What a marching method needs to know of a body's connectivity; made once, renewed after a
 * topology change. */
struct FieldTopology
{
  const BoundarySurface* surface = nullptr;
  const Adjacency* node_neighbours = nullptr;
};

/** Depth inside a body on its nodes: of tets, or of triangles in a plane (see
 * extractPlanarBoundary). */
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

  /** Per node the boundary triangle found nearest to it (index into surface->triangles), -1 where
   * not marched or not told. */
  virtual const std::vector<Index>& closestTriangle() const = 0;

  /** Distances from a point to a boundary feature worked out so far, all marches together. */
  virtual std::uint64_t evaluations() const = 0;

  /** Writes, or reads, what later marches and readers depend on. */
  virtual void exchange(StateArchive& archive) = 0;
};

/** What single methods need beside the topology. */
struct FieldOptions
{
  static constexpr int kLeastGridPoints = 8;
  /** grid: points along the longest side of the body as it is first marched; cells are cubes then,
   * and stretched with the body later. */
  int grid_points = 40;
};

/**
 * A field by name. It keeps the pointers of the topology.
 *
 * - "cpfm": distance to the nearest boundary node, as neighbours tell of it: the closest-point fast
 *   marching of [Marchal2004]. Above the true depth by up to the size of boundary triangles.
 * - "cffm": the same with boundary triangles: closest-feature fast marching. At or above the true
 *   depth.
 * - "exact_marching": the true depth.
 * - "grid": a grid's depth, marched to second order and read at the nodes by slopes; it tells no
 *   closest triangles. See GridField.
 * @throws Error naming the known methods, or if parts of the topology are missing or don't match,
 *         or for options out of range
 */
std::unique_ptr<DistanceField> makeDistanceField(const std::string& method,
                                                 const FieldTopology& topology,
                                                 const FieldOptions& options = {});

}  // namespace soft_tissue
