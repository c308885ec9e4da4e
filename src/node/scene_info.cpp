#include "soft_tissue_sim/node/scene_info.h"

#include "soft_tissue_sim/base/hash.h"

namespace soft_tissue_sim
{
namespace
{
std::uint64_t topologyId(const soft_tissue::TissueInfo& tissue)
{
  soft_tissue::StateHash hash;
  hash.addValue(tissue.rest.nodes.size());
  const auto& tets = tissue.rest.tets;
  const auto& triangles = tissue.surface.triangles;
  hash.add(tets.data(), tets.size() * sizeof(soft_tissue::Tet));
  if (tissue.isMembrane())
  {
    hash.add(triangles.data(), triangles.size() * sizeof(soft_tissue::Triangle));
  }
  return hash.value();
}

}  // namespace

SceneInfo::SceneInfo(const soft_tissue::Scene& scene)
    : tissues(scene.tissues()), tools(scene.tools()), tool_configs(scene.config().tools)
{
  for (const soft_tissue::TissueInfo& tissue : tissues)
  {
    tissue_names.push_back(tissue.name);
    topology_ids.push_back(topologyId(tissue));
  }
  soft_tissue::Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  for (const soft_tissue::TissuePairState& pair : snapshot.tissue_pairs)
  {
    const auto first = static_cast<std::size_t>(pair.first);
    const auto second = static_cast<std::size_t>(pair.second);
    tissue_pairs.push_back({first, second, tissue_names[first] + "/" + tissue_names[second]});
  }
}

}  // namespace soft_tissue_sim
