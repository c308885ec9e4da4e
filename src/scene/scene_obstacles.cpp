#include <algorithm>
#include <cmath>

#include "bodies.h"
#include "octomap_file.h"
#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** Tissue may start touching an obstacle, but not deeper than this part of half a cell. */
constexpr double kDeepStart = 0.5;

constexpr int kTreeDepth = 16;

/** All there is, m. */
const Box3 kEverywhere = {Vec3::Constant(-1e9), Vec3::Constant(1e9)};

bool same(const Box3& a, const Box3& b)
{
  return a.min == b.min && a.max == b.max;
}
}  // namespace

void Scene::Impl::addObstacle(std::size_t index)
{
  const ObstacleConfig& config = config_.obstacles[index];
  Obstacle obstacle;
  obstacle.changes = config.octomap.file.empty();
  obstacle.shape = std::make_shared<VoxelShape>(
      obstacle.changes
          ? VoxelSet(config.octomap.resolution_m * (1 << (kTreeDepth - config.octomap.depth)))
          : readOctomap(config.octomap, item(config_, "obstacles", index) + ".octomap"));
  obstacle.X_WO = config.pose.toPose();
  obstacle_info_.push_back({config.name, {}, obstacle.shape->cells().cellSize()});
  obstacles_.push_back(std::move(obstacle));
}

/** @throws Error when the tissue of a pair starts inside its obstacle */
void Scene::Impl::refuseDeepStart(const Contact& contact)
{
  contact.with_obstacle->beginStep(x_);
  const Obstacle& obstacle = obstacles_[contact.other];
  const TissueInfo& tissue = tissue_info_[contact.tissue];
  const Pose X_OW = obstacle.X_WO.inverse();
  double deepest = contact.term->active() ? contact.term->deepest(x_) : 0.0;
  for (const Index node : tissue.surface.nodes)
  {
    deepest = std::max(deepest, -obstacle.shape->distance(X_OW * tissue.rest.nodes[node]).distance);
  }
  if (deepest > kDeepStart * contact.size_m)
  {
    throw Error(item(config_, "obstacles", contact.other) + " '" +
                config_.obstacles[contact.other].name + "': tissue '" + tissue.name + "' starts " +
                std::to_string(1e3 * deepest) +
                " mm deep inside it, must start outside: set the pose of either");
  }
}

/** Lets an obstacle become another between steps: what it takes in is allowed to be there for a
 * while. */
VoxelSet Scene::Impl::setObstacle(std::size_t index, VoxelSet cells, const Pose& X_WO)
{
  Obstacle& obstacle = obstacles_.at(index);
  checkObstacle(index, cells, X_WO);
  const bool moves = X_WO.matrix() != obstacle.X_WO.matrix();
  const std::optional<Box3> changed_O = obstacle.shape->changes(cells);
  if (!moves && !changed_O)
  {
    return obstacle.shape->exchange(std::move(cells));
  }
  const Box3 where = moves ? kEverywhere : transformed(X_WO, *changed_O);
  const auto forContacts = [&](const auto& visit) {
    for (Contact& contact : contacts_)
    {
      if (contact.with_obstacle != nullptr && contact.other == index)
      {
        visit(contact);
      }
    }
  };
  forContacts([&](Contact& contact) { contact.with_obstacle->beforeChange(x_, where); });
  cells = obstacle.shape->exchange(std::move(cells));
  obstacle.X_WO = X_WO;
  bool any = false;
  forContacts([&](Contact& contact) {
    contact.with_obstacle->afterChange(x_, X_WO);
    contact.allowance_m = contact.with_obstacle->easeAllowances(0.0);
    const Tissue& tissue = tissues_[contact.tissue];
    Box3 reach;
    std::for_each_n(x_.begin() + tissue.first_node, tissue.node_count,
                    [&](const Vec3& p) { reach.extend(p); });
    reach.grow(tissue.short_edge);
    if (asleep_[contact.tissue] != 0 && reach.overlaps(where))
    {
      wake(island_[contact.tissue]);
      any = true;
    }
  });
  if (any)
  {
    setSleepers();
  }
  newton_->forgetMatrix();
  obstacle.shown = Box3();
  showObstacles();
  return cells;
}

void Scene::Impl::checkObstacle(std::size_t index, const VoxelSet& cells, const Pose& X_WO) const
{
  const std::string name =
      item(config_, "obstacles", index) + " '" + config_.obstacles[index].name + "'";
  const double size = obstacles_[index].shape->cells().cellSize();
  if (cells.cellSize() != size)
  {
    throw Error(name + " has cells of " + std::to_string(size) + " m, given are some of " +
                std::to_string(cells.cellSize()) + " m");
  }
  const Mat3 rotation = X_WO.linear();
  if (!X_WO.matrix().allFinite() || !(rotation.determinant() > 0.0) ||
      (rotation.transpose() * rotation - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-9)
  {
    throw Error(name + ": a pose to set must be a rotation and a finite translation");
  }
}

/** How far the tissue of a pair moves in this step, m; 0 where its obstacle is out of reach. */
double Scene::Impl::motionInObstacle(const Contact& contact) const
{
  Box3 reach;
  const double moved = motionOfTissue(contact.tissue, Vec3::Zero(), reach);
  const Obstacle& obstacle = obstacles_[contact.other];
  return obstacle.shape->touches(transformed(obstacle.X_WO.inverse(), reach)) ? moved : 0.0;
}

/** Has the surfaces for display follow what tissues have come near to. */
void Scene::Impl::showObstacles()
{
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
  {
    Obstacle& obstacle = obstacles_[k];
    const Box3 covered = obstacle.shape->covered();
    if (same(covered, obstacle.shown))
    {
      continue;
    }
    obstacle.shown = covered;
    SurfaceMesh surface = obstacle.shape->surface(1e300);
    for (Vec3& node : surface.nodes)
    {
      node = obstacle.X_WO * node;
    }
    obstacle_info_[k].surface = {std::move(surface.nodes), std::move(surface.triangles)};
  }
}

}  // namespace soft_tissue
