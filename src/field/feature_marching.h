#pragma once

#include "nodal_field.h"
#include "node_heap.h"

namespace soft_tissue
{
/** Boundary triangles: the closest-feature method. */
struct TriangleFeatures
{
  /** Features on a node of the boundary. */
  static const Index* begin(const BoundarySurface& surface, const Index& node)
  {
    return surface.node_triangles.begin(node);
  }
  static const Index* end(const BoundarySurface& surface, const Index& node)
  {
    return surface.node_triangles.end(node);
  }
  static double squaredDistance(const BoundarySurface& surface, Index triangle, const Points& x,
                                const Vec3& p);
  static Index triangle(const BoundarySurface&, Index triangle) { return triangle; }
};

/** Boundary nodes: the closest-point method. */
struct NodeFeatures
{
  static const Index* begin(const BoundarySurface&, const Index& node) { return &node; }
  static const Index* end(const BoundarySurface&, const Index& node) { return &node + 1; }
  static double squaredDistance(const BoundarySurface&, Index node, const Points& x, const Vec3& p)
  {
    return (p - x[node]).squaredNorm();
  }
  static Index triangle(const BoundarySurface& surface, Index node)
  {
    return *surface.node_triangles.begin(node);
  }
};

/**
 * Fast marching over the mesh: nodes in order of distance, each handing the boundary feature
 * closest to it on to its neighbours. A depth may be too large where the nearest feature reaches a
 * node by no neighbour, never too small.
 *
 * All memory is taken at construction; a march undoes only what the one before it touched.
 * Source: [Marchal2004] CFFM, with triangles as features, and CPFM.
 */
template <typename Feature>
class FeatureMarching : public NodalField
{
 public:
  explicit FeatureMarching(const FieldTopology& topology);

  void march(const Points& x) override;
  void marchUntil(const Points& x, const std::vector<Index>& wanted) override;

 private:
  /** The nearest feature offered to a node so far. */
  struct Offer
  {
    double squared_distance;  ///< m^2, +infinity before the first
    Index feature;            ///< -1 before the first
  };

  void collectSeeds();
  void begin(const Points& x);
  Index countMissing(const std::vector<Index>& wanted);
  void seed(const Points& x);
  void run(const Points& x, Index missing);
  void offer(Index node, Index feature, const Points& x);

  Adjacency seeds_;  ///< rows as seed_nodes_: features on a node's boundary neighbours
  std::vector<Index> seed_nodes_;  ///< inner nodes beside the boundary
  std::vector<Offer> offers_;
  std::vector<unsigned> wanted_in_march_;
  unsigned march_number_ = 0;
  NodeHeap heap_;
};

}  // namespace soft_tissue
