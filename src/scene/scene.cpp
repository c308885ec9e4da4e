#include "soft_tissue_sim/scene/scene.h"

#include <algorithm>
#include <string>

#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"
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
  forTets([](TissueElasticity& tets) { tets.forget(); });
  setOff();
  newton_->forget();
  for (std::size_t k = 0; k < tools_.size(); ++k)
  {
    detach(k, std::nullopt);
    placeTool(k);
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
  forgetWay();
}

void Scene::Impl::restart()
{
  report_.step = 0;
  report_.time_s = 0.0;
  resetWorld();
}

/** What was found on the way must not show in what follows. */
void Scene::Impl::forgetWay()
{
  forgetPast();
  std::fill(asleep_.begin(), asleep_.end(), 0);
  std::fill(quiet_s_.begin(), quiet_s_.end(), 0.0);
  setSleepers();
  newton_->forget();
  for (Contact& contact : contacts_)
  {
    contact.term->forget();
    if (contact.with_tissue != nullptr)
    {
      allow(contact.start_depth_m, contact);
    }
    // Where the tissue is now, cells may have come that were not there when the scene was made.
    if (contact.with_obstacle != nullptr && obstacles_[contact.other].changes)
    {
      contact.with_obstacle->allowAll(x_);
      contact.allowance_m = contact.with_obstacle->easeAllowances(0.0);
    }
  }
}

void Scene::Impl::setMotion(std::size_t tissue, const Points& positions, const Points& velocities)
{
  const TissueInfo& info = tissue_info_.at(tissue);
  const std::size_t count = info.rest.nodes.size();
  const auto finite = [](const Vec3& p) { return p.allFinite(); };
  if (positions.size() != count || velocities.size() != count)
  {
    throw Error("tissue " + info.name + " has " + std::to_string(count) + " nodes, given are " +
                std::to_string(positions.size()) + " positions and " +
                std::to_string(velocities.size()) + " velocities");
  }
  if (!std::all_of(positions.begin(), positions.end(), finite) ||
      !std::all_of(velocities.begin(), velocities.end(), finite))
  {
    throw Error("tissue " + info.name + ": a position or velocity to set is not finite");
  }
  const Index first = tissues_[tissue].first_node;
  for (std::size_t i = 0; i < count; ++i)
  {
    const Index file_node = tissues_[tissue].file_node[i];
    x_[first + i] = positions[file_node];
    v_[first + i] = velocities[file_node];
  }
  std::fill_n(acceleration_.begin() + first, count, Vec3::Zero());
  forgetWay();
}

std::uint64_t Scene::Impl::stateHash() const
{
  StateHash hash;
  hash.addValue(report_.step);
  hash.add(x_.data(), x_.size() * sizeof(Vec3));
  hash.add(v_.data(), v_.size() * sizeof(Vec3));
  hash.add(acceleration_.data(), acceleration_.size() * sizeof(Vec3));
  for (const Tissue& tissue : tissues_)
  {
    if (tissue.tets != nullptr)
    {
      tissue.tets->addTo(hash);
    }
  }
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
    hash.add(tool.joints.data(), tool.joints.size() * sizeof(double));
  }
  for (const Attachment& attached : attachments_)
  {
    hash.addValue(attached.tool);
    hash.addValue(attached.part);
    hash.addValue(attached.row);
    hash.add(attached.place_P.data(), sizeof(Vec3));
    hash.addValue(attached.stiffness);
  }
  for (const Obstacle& obstacle : obstacles_)
  {
    hash.add(obstacle.X_WO.data(), 16 * sizeof(double));
    hash.addValue(obstacle.shape->cells().contents());
    hash.addValue(obstacle.shape->cells().othersOccupied());
  }
  for (const Contact& contact : contacts_)
  {
    hash.addValue(contact.allowance_m);
    contact.term->addTo(hash);
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
    state.positions.resize(tissue.node_count);
    state.velocities.resize(tissue.node_count);
    for (Index i = 0; i < tissue.node_count; ++i)
    {
      state.positions[tissue.file_node[i]] = x_[tissue.first_node + i];
      state.velocities[tissue.file_node[i]] = v_[tissue.first_node + i];
    }
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
  return impl_->tissues_in_file_order_;
}

const std::vector<ToolInfo>& Scene::tools() const
{
  return impl_->tool_info_;
}

const std::vector<ObstacleInfo>& Scene::obstacles() const
{
  return impl_->obstacle_info_;
}

const Pose& Scene::toolPose(std::size_t tool) const
{
  return impl_->tools_.at(tool).X_WT;
}

double Scene::time() const
{
  return impl_->report_.time_s;
}

void Scene::setToolTarget(std::size_t tool, const Pose& X_WT)
{
  impl_->tools_.at(tool).X_WT_target = X_WT;
}

void Scene::setJointTargets(std::size_t tool, const JointValues& values)
{
  impl_->setJointTargets(tool, values);
}

int Scene::attach(const AttachRequest& request)
{
  return impl_->attach(request);
}

int Scene::detach(std::size_t tool, std::optional<std::size_t> part)
{
  return impl_->detach(tool, part);
}

const StepReport& Scene::step()
{
  return impl_->step();
}

void Scene::resetWorld()
{
  impl_->resetWorld();
}

void Scene::restart()
{
  impl_->restart();
}

VoxelSet Scene::setObstacleCells(std::size_t obstacle, VoxelSet cells)
{
  return impl_->setObstacle(obstacle, std::move(cells), impl_->obstacles_.at(obstacle).X_WO);
}

VoxelSet Scene::setObstacle(std::size_t obstacle, VoxelSet cells, const Pose& X_WO)
{
  return impl_->setObstacle(obstacle, std::move(cells), X_WO);
}

void Scene::setMotion(std::size_t tissue, const Points& positions, const Points& velocities)
{
  impl_->setMotion(tissue, positions, velocities);
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
