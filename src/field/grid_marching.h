#pragma once

#include <optional>

#include "nodal_field.h"
#include "soft_tissue_sim/field/grid_field.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"

namespace soft_tissue
{
/**
 * Nodal depths read from a grid that follows the body's bounds.
 *
 * A node for which the grid shows no depth, where the body is thinner than a cell, folded or turned
 * inside out, gets its distance to the nearest triangle.
 */
class GridMarching : public NodalField
{
 public:
  /** @throws Error for fewer points than FieldOptions tells */
  GridMarching(const FieldTopology& topology, int points);

  void march(const Points& x) override;
  /** The whole grid is marched; what is saved is reading it. */
  void marchUntil(const Points& x, const std::vector<Index>& wanted) override;
  void exchange(StateArchive& archive) override;

 private:
  void marchGrid(const Points& x);
  GridSpec placed(const Points& x) const;
  void fitTree(const Points& x);
  void read(Index node, const Points& x);

  int points_;
  bool planar_ = true;
  std::optional<GridField> grid_;
  Points built_at_;         ///< where nodes were when the grid was made
  Points tree_built_at_;    ///< and the tree
  TriangleTree tree_;       ///< for nodes the grid shows no depth for
  bool tree_fits_ = false;  ///< to the positions being marched
};

}  // namespace soft_tissue
