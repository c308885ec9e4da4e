#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/node/message_builders.h"

namespace soft_tissue_sim
{
/**
 * Nodal depths for those who want to see them, marched on snapshots by whoever publishes them: the
 * physics neither waits nor pays for it.
 */
class TissueDepths
{
 public:
  /** Tissues that no contact names have no field. */
  TissueDepths(const SceneInfo& info, const soft_tissue::SceneConfig& config);

  bool has(std::size_t tissue) const { return views_[tissue].field != nullptr; }

  /**
   * Depths in a snapshot, one per node, m: 0 on the boundary, > 0 inside, NaN where none was found.
   * Marched once per snapshot and tissue; only for tissues that have() a field.
   */
  const std::vector<double>& depth(std::size_t tissue, const soft_tissue::Snapshot& snapshot);

 private:
  struct View
  {
    soft_tissue::Adjacency node_neighbours;
    std::unique_ptr<soft_tissue::DistanceField> field;
    bool marched = false;
    std::uint64_t state_hash = 0;  ///< of the snapshot marched last
  };
  std::deque<View> views_;  ///< one per tissue; fields hold pointers into it
};

}  // namespace soft_tissue_sim
