#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** Two tissues that may touch; a tissue that may touch itself is both. */
struct TissuePairInfo
{
  std::size_t first = 0, second = 0;  ///< indices of the tissues
  std::string name;                   ///< first/second: the slash is in no tissue's or tool's name
};

/** A scene's unchanging part as messages need it: names, rest meshes, topology ids. */
struct SceneInfo
{
  explicit SceneInfo(const soft_tissue::Scene& scene);

  std::vector<soft_tissue::TissueInfo> tissues;
  std::vector<soft_tissue::ToolInfo> tools;
  std::vector<soft_tissue::ToolConfig> tool_configs;
  std::vector<std::string> tissue_names;
  std::vector<std::uint64_t> topology_ids;   ///< per tissue: hash of node count and tets
  std::vector<TissuePairInfo> tissue_pairs;  ///< in the order of Snapshot::tissue_pairs
};

}  // namespace soft_tissue_sim
