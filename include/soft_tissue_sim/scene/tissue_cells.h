#pragma once

#include <vector>

#include "soft_tissue_sim/geometry/voxel_set.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
/** The deformed tissues and membranes of a scene as cells of a grid: occupied where anything of
 * them is. */
class TissueCells
{
 public:
  /**
   * @param tissues  of the scene; they must outlive this
   * @throws Error for cells so small that there would be too many
   */
  TissueCells(const SceneConfig& config, const std::vector<TissueInfo>& tissues);

  /** Takes the tissues' positions. */
  void update(const Snapshot& snapshot);

  /** Those with tissue in them, world. */
  const VoxelSet& occupied() const { return occupied_; }
  /** Those that have had tissue in them at an update. */
  const VoxelSet& seen() const { return seen_; }

 private:
  const std::vector<TissueInfo>& tissues_;
  VoxelSet occupied_, seen_;
};

}  // namespace soft_tissue
