#pragma once

#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
/** What all fields on nodes have in common: values, of which the boundary's never change, and what
 * a march has to undo of the one before it. */
class NodalField : public DistanceField
{
 public:
  const std::vector<double>& depth() const override { return depth_; }
  const std::vector<Index>& closestTriangle() const override { return closest_; }
  std::uint64_t evaluations() const override { return evaluations_; }
  void exchange(StateArchive& archive) override;

 protected:
  /** @throws Error if parts of the topology are missing or don't match */
  explicit NodalField(const FieldTopology& topology);

  std::size_t nodeCount() const { return depth_.size(); }

  /** Takes back the values of touched nodes. @throws Error unless there is a position for each node
   */
  void forgetMarch(const Points& x);

  /** The positions, zero in place of those that are no numbers. */
  static Points finiteOf(Points x);

  /** @throws Error for a node that isn't there */
  void checkWanted(const std::vector<Index>& wanted) const;

  FieldTopology topology_;
  std::vector<double> depth_;
  std::vector<Index> closest_;
  std::vector<Index> touched_;  ///< inner nodes that a march gave anything to
  std::uint64_t evaluations_ = 0;
};

}  // namespace soft_tissue
