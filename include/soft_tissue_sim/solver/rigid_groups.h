#pragma once

#include <Eigen/Core>
#include <vector>

#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/**
 * The coarse level of a preconditioner for elastic bodies: nearby nodes in groups, each of which
 * may move like a rigid body. Those are the slow motions that neighbours alone take long to agree
 * on. What is much stiffer than the rest of its body is a group, or several, by itself. For
 * matrices of one pattern, with the same fixed nodes.
 */
class RigidGroups
{
 public:
  /**
   * Makes, or renews, the coarse matrix P^T A P for rigid motions P at positions x; the groups are
   * those of the first time. A that isn't positive definite on them leaves no coarse level.
   */
  void build(const BlockMatrix& a, const Points& x);

  /** Whether nodes have moved so far since build() that other motions are rigid now, or bodies are
   * coupled quite otherwise. */
  bool outdated(const BlockMatrix& a, const Points& x) const;

  /** Writes, or reads, the groups and the level that there are. */
  void exchange(StateArchive& archive);

  /** How many times more strongly the best held node is held than the worst, among those that
   * others couple to. */
  double contrast() const { return contrast_; }
  /** Whether that takes more than one material. */
  bool isUneven() const { return contrast_ > kMostEven; }

  int size() const { return static_cast<int>(offsets_.size()) - 1; }  ///< groups; 0 without level
  /** Nodes of group g: nodes()[offsets()[g]] ... nodes()[offsets()[g + 1] - 1]. */
  const std::vector<Index>& offsets() const { return offsets_; }
  /** All nodes of A, group by group, with near groups after each other; then those in none. */
  const std::vector<Index>& nodes() const { return nodes_; }
  /** Per node of A: its group; size() for nodes in none, that nothing couples to others. */
  const std::vector<Index>& group() const { return group_; }
  /** Per node of A: from its group's centre, in units that make it about 1; 3 each. */
  const std::vector<double>& arms() const { return arms_; }
  /** Inverse of the coarse matrix, 6 size() square; per group 3 translations and 3 rotations. */
  const std::vector<double>& inverse() const { return inverse_; }

 private:
  static constexpr double kMostEven = 1e3;  ///< contrast of one material at most

  bool isBent(Index g, const Points& x) const;
  void makeGroups(const BlockMatrix& a, const Points& x);
  void measureContrast(const BlockMatrix& a);
  void placeArms(const Points& x);
  void addBlocks(const BlockMatrix& a, Eigen::MatrixXd& coarse) const;
  void addOuter(const OuterProducts& outer, Eigen::MatrixXd& coarse) const;
  double evenness() const;

  bool usable_ = false;  ///< the coarse matrix was positive definite, or there are no groups
  std::vector<Index> offsets_ = {0};
  std::vector<Index> nodes_;
  std::vector<Index> group_;
  std::vector<double> sizes_;  ///< of groups, m
  std::vector<double> arms_;
  std::vector<double> inverse_;
  double contrast_ = 1.0;
  double coupling_ = 0.0;  ///< how strong couplings were when the coarse matrix was made, N/m
  Points built_at_;
};

}  // namespace soft_tissue
