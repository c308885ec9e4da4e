#include "soft_tissue_sim/scene/scene.h"

#include <algorithm>

#include "scene_impl.h"
#include "soft_tissue_sim/base/hash.h"

namespace soft_tissue
{
/** The velocities of the start. */
void Scene::Impl::setOff()
{
  stop();
  forgetPast();
  const Points still = v_;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    std::fill_n(v_.begin() + tissues_[k].first_node, tissues_[k].node_count,
                config_.softBody(k).velocity_m_per_s);
  }
  newton_->restoreFixed(still, v_);
}

void Scene::Impl::resetWorld()
{
  x_ = x_rest_;
  setOff();
  for (std::size_t k = 0; k < tools_.size(); ++k)
  {
    Tool& tool = tools_[k];
    tool.X_WT =
        tool.track.empty() ? config_.tools[k].initial_pose.toPose() : tool.track.at(report_.time_s);
    tool.X_WT_goal = tool.X_WT;
    tool.state = ToolState();
    tool.state.X_WT = tool.X_WT;
  }
  for (Obstacle& obstacle : obstacles_)
  {
    obstacle.state.contacts.clear();
  }
  const std::uint64_t number = report_.step;
  const double time_s = report_.time_s;
  report_ = StepReport();
  report_.step = number;
  report_.time_s = time_s;
  // What was found on the way must not show in what follows.
  std::fill(asleep_.begin(), asleep_.end(), 0);
  std::fill(quiet_s_.begin(), quiet_s_.end(), 0.0);
  setSleepers();
  for (Contact& contact : contacts_)
  {
    contact.term->forget();
    if (contact.with_tissue != nullptr)
    {
      allow(contact.start_depth_m, contact);
    }
  }
}

std::uint64_t Scene::Impl::stateHash() const
{
  StateHash hash;
  hash.addValue(report_.step);
  hash.add(x_.data(), x_.size() * sizeof(Vec3));
  hash.add(v_.data(), v_.size() * sizeof(Vec3));
  hash.add(acceleration_.data(), acceleration_.size() * sizeof(Vec3));
  if (config_.solver.stepper == Stepper::bdf2)
  {
    hash.add(x_last_.data(), x_last_.size() * sizeof(Vec3));
    hash.add(v_last_.data(), v_last_.size() * sizeof(Vec3));
    hash.add(smooth_.data(), smooth_.size());
    hash.addValue(last_h_);
  }
  if (config_.solver.sleep)
  {
    hash.add(asleep_.data(), asleep_.size());
    hash.add(quiet_s_.data(), quiet_s_.size() * sizeof(double));
    hash.add(island_.data(), island_.size() * sizeof(std::size_t));
  }
  for (const Tool& tool : tools_)
  {
    hash.add(tool.X_WT.data(), 16 * sizeof(double));
  }
  return hash.value();
}

void Scene::Impl::fillSnapshot(Snapshot& snapshot)
{
  snapshot.report = report_;
  snapshot.state_hash = stateHash();
  snapshot.tissues.resize(tissues_.size());
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const Tissue& tissue = tissues_[k];
    TissueState& state = snapshot.tissues[k];
    const auto first = x_.begin() + tissue.first_node;
    state.positions.assign(first, first + tissue.node_count);
    const auto first_v = v_.begin() + tissue.first_node;
    state.velocities.assign(first_v, first_v + tissue.node_count);
    state.asleep = asleep_[k] != 0;
    state.evaluations = tissue.evaluations;
    if (config_.outputs.stress && tissue.tets != nullptr)
    {
      tissue.tets->vonMises(x_, state.von_mises);
    }
  }
  snapshot.tools.resize(tools_.size());
  for (std::size_t k = 0; k < tools_.size(); ++k)
  {
    snapshot.tools[k] = tools_[k].state;
  }
  snapshot.obstacles.resize(obstacles_.size());
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
  {
    snapshot.obstacles[k] = obstacles_[k].state;
  }
  snapshot.tissue_pairs = pairs_;
}

Scene::Scene(const SceneConfig& config) : impl_(std::make_unique<Impl>(config)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const SceneConfig& Scene::config() const
{
  return impl_->config_;
}

const std::vector<TissueInfo>& Scene::tissues() const
{
  return impl_->tissue_info_;
}

const std::vector<ToolInfo>& Scene::tools() const
{
  return impl_->tool_info_;
}

const std::vector<ObstacleInfo>& Scene::obstacles() const
{
  return impl_->obstacle_info_;
}

double Scene::time() const
{
  return impl_->report_.time_s;
}

void Scene::setToolTarget(std::size_t tool, const Pose& X_WT)
{
  impl_->tools_.at(tool).X_WT_goal = X_WT;
}

const StepReport& Scene::step()
{
  return impl_->step();
}

void Scene::resetWorld()
{
  impl_->resetWorld();
}

std::uint64_t Scene::stateHash() const
{
  return impl_->stateHash();
}

void Scene::fillSnapshot(Snapshot& snapshot) const
{
  impl_->fillSnapshot(snapshot);
}

}  // namespace soft_tissue
