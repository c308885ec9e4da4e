#include "soft_tissue_sim/node/tissue_depths.h"

#include <algorithm>

#include "soft_tissue_sim/scene/tissue_field.h"

namespace soft_tissue_sim
{
TissueDepths::TissueDepths(const SceneInfo& info, const soft_tissue::SceneConfig& config)
{
  for (std::size_t i = 0; i < info.tissues.size(); ++i)
  {
    View& view = views_.emplace_back();
    const soft_tissue::TissueInfo& tissue = info.tissues[i];
    const bool touchable =
        std::any_of(config.contacts.begin(), config.contacts.end(),
                    [&](const soft_tissue::ContactConfig& contact) {
                      return contact.tissue == tissue.name || contact.other == tissue.name;
                    });
    if (touchable && !tissue.isMembrane())
    {
      const auto node_count = static_cast<soft_tissue::Index>(tissue.rest.nodes.size());
      view.node_neighbours = soft_tissue::nodeNeighbours(node_count, tissue.rest.tets);
      view.field = soft_tissue::makeDistanceField(config.tissues[i].field,
                                                  {&tissue.surface, &view.node_neighbours});
    }
  }
}

const std::vector<double>& TissueDepths::depth(std::size_t tissue,
                                               const soft_tissue::Snapshot& snapshot)
{
  View& view = views_[tissue];
  if (!view.marched || view.state_hash != snapshot.state_hash)
  {
    view.field->march(snapshot.tissues[tissue].positions);
    view.state_hash = snapshot.state_hash;
    view.marched = true;
  }
  return view.field->depth();
}

}  // namespace soft_tissue_sim
