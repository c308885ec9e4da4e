#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "soft_tissue_sim/node/bag_maps.h"
#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/run_options.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** What a run of a scene without a roscore takes: the scene, and where a bag has its tools. */
struct Replay
{
  soft_tissue::SceneConfig config;
  std::shared_ptr<const ScratchFolder> scratch;  ///< has meshes that the config names
  BagPoses poses;                                ///< no tools if there is no bag
  std::vector<BagMaps> maps;                     ///< per obstacle; none if there is no bag
  std::uint64_t steps = 0;
  bool from_now = false;  ///< so many more, wherever the scene is; else counted from its start

  /** Number of the last step of a scene that has taken so many. */
  std::uint64_t lastStep(std::uint64_t done) const
  {
    return from_now ? done + steps : std::max(done, steps);
  }
};

/**
 * Reads scene and bag, and sets the number of threads; what the bag's reading has to say goes to
 * standard error.
 * @throws soft_tissue::Error if either can't be read, or nothing tells how long it takes
 */
Replay readReplay(const RunOptions& options);

/** Takes a scene through it, from where it is. @param seen  is called after each step; whether to
 * go on */
void runReplay(soft_tissue::Scene& scene, const Replay& replay,
               const std::function<bool(const soft_tissue::Snapshot&)>& seen);

}  // namespace soft_tissue_sim
