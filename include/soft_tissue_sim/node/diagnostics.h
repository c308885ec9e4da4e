#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <mutex>
#include <vector>

#include "soft_tissue_sim/node/command_gate.h"
#include "soft_tissue_sim/node/map_input.h"
#include "soft_tissue_sim/node/octomap_topics.h"
#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/scene_topics.h"

namespace soft_tissue_sim
{
/** `/diagnostics`: how the physics goes and what became of each tool's commands and each obstacle's
 * maps. */
class Diagnostics
{
 public:
  /** @param octomap_topics  null: none */
  Diagnostics(const PhysicsLoop& loop, const SceneTopics& scene_topics,
              const OctomapTopics* octomap_topics, const std::vector<const CommandWatch*>& watches,
              const std::deque<MapInput>& maps);

  /** Notes the newest frame's figures; called by the publishing thread. */
  void note(const Frame& frame);
  /** Publishes; called once a second. */
  void update() { updater_.force_update(); }

 private:
  void reportPhysics(diagnostic_updater::DiagnosticStatusWrapper& status);

  const PhysicsLoop& loop_;
  const SceneTopics& scene_topics_;
  const OctomapTopics* octomap_topics_;
  diagnostic_updater::Updater updater_;
  std::mutex mutex_;
  soft_tissue::StepReport report_;
  double real_time_factor_ = 0.0;
  std::uint64_t reported_missed_ = 0;
};

}  // namespace soft_tissue_sim
