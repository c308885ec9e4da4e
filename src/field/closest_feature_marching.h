#pragma once

#include "node_heap.h"
#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
/**
 * Closest-feature fast marching: a depth may be too large where the nearest triangle reaches a node
 * by no neighbour, never too small.
 *
 * All memory is taken at construction; a march undoes only what the one before it touched.
 * Source: [Marchal2004] CFFM, with triangles as features.
 */
class ClosestFeatureMarching : public DistanceField
{
 public:
  explicit ClosestFeatureMarching(const FieldTopology& topology);

  void march(const Points& x) override;
  void marchUntil(const Points& x, const std::vector<Index>& wanted) override;
  const std::vector<double>& depth() const override { return depth_; }
  const std::vector<Index>& closestTriangle() const override { return closest_; }

 private:
  /** The nearest triangle offered to a node so far. */
  struct Offer
  {
    double squared_distance;  ///< m^2, +infinity before the first
    Index triangle;           ///< -1 before the first
  };

  void collectSeeds();
  void begin(const Points& x);
  Index countMissing(const std::vector<Index>& wanted);
  void seed(const Points& x);
  void run(const Points& x, Index missing);
  void offer(Index node, Index triangle, const Points& x);

  FieldTopology topology_;
  Adjacency seeds_;  ///< rows as seed_nodes_: triangles on a node's boundary neighbours
  std::vector<Index> seed_nodes_;  ///< inner nodes beside the boundary
  std::vector<double> depth_;
  std::vector<Index> closest_;
  std::vector<Offer> offers_;
  std::vector<Index> touched_;  ///< inner nodes with an offer
  std::vector<unsigned> wanted_in_march_;
  unsigned march_number_ = 0;
  NodeHeap heap_;
};

}  // namespace soft_tissue
