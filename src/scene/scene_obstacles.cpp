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

bool same(const Box3& a, const Box3& b)
{
  return a.min == b.min && a.max == b.max;
}
}  // namespace

void Scene::Impl::addObstacle(std::size_t index)
{
  const ObstacleConfig& config = config_.obstacles[index];
  Obstacle obstacle;
  obstacle.shape = std::make_shared<VoxelShape>(
      readOctomap(config.octomap, item(config_, "obstacles", index) + ".octomap"));
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
