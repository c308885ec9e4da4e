#include "soft_tissue_sim/node/distance_service.h"

#include <cmath>
#include <limits>
#include <utility>

#include "soft_tissue_sim/node/bounded_service.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
DistanceService::DistanceService(const ros::NodeHandle& node, const SceneInfo& info,
                                 std::string world_frame)
    : info_(info), world_frame_(std::move(world_frame)), node_(node), spinner_(1, &queue_)
{
  for (const soft_tissue::TissueInfo& tissue : info.tissues)
  {
    bodies_.emplace_back(tissue.surface);
  }
  node_.setCallbackQueue(&queue_);
  server_ = advertiseBounded<QueryDistance, Request>(
      node_, "query_distance", [this](Request& request, QueryDistance::Response& response) {
        return query(request, response);
      });
  spinner_.start();
}

void DistanceService::note(const Frame& frame)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_.positions.resize(frame.snapshot.tissues.size());
  for (std::size_t i = 0; i < newest_.positions.size(); ++i)
  {
    newest_.positions[i] = frame.snapshot.tissues[i].positions;
  }
  newest_.stamp = frame.stamp;
  newest_.step = frame.snapshot.report.step;
  newest_.state_hash = frame.snapshot.state_hash;
  newest_.known = true;
}

/** Brings bodies_ to the newest frame, unless they are there. */
void DistanceService::takeNewest()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    asked_.stamp = newest_.stamp;
    asked_.step = newest_.step;
    if (!newest_.known || (asked_.known && asked_.state_hash == newest_.state_hash))
    {
      return;
    }
    asked_ = newest_;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i)
  {
    bodies_[i].update(asked_.positions[i]);
  }
}

bool DistanceService::query(Request& request, QueryDistance::Response& response)
{
  const std::string wanted(request.tissue.begin(), request.tissue.end());
  std::vector<std::size_t> tissues;
  std::string names;
  for (std::size_t i = 0; i < info_.tissues.size(); ++i)
  {
    names += (i > 0 ? ", " : "") + info_.tissues[i].name;
    if (wanted.empty() || wanted == info_.tissues[i].name)
    {
      tissues.push_back(i);
    }
  }
  if (tissues.empty() && !wanted.empty())
  {
    response.message = "tissue = '" + wanted + "', must be one of: " + names;
    return true;
  }
  if (!(request.max_distance >= 0.0))
  {
    response.message = "max_distance = " + std::to_string(request.max_distance) + ", must be >= 0";
    return true;
  }
  takeNewest();
  if (!asked_.known)
  {
    response.message = "no step is finished yet";
    return true;
  }
  response.header.frame_id = world_frame_;
  response.header.stamp = asked_.stamp;
  response.step = asked_.step;
  for (const auto& point : request.points)
  {
    answer(soft_tissue::Vec3(point.x, point.y, point.z), tissues, request.max_distance, response);
  }
  response.success = true;
  return true;
}

void DistanceService::answer(const soft_tissue::Vec3& p, const std::vector<std::size_t>& tissues,
                             double max_distance, QueryDistance::Response& response) const
{
  soft_tissue::DeformedDistance::Answer deepest;
  std::string name;
  for (const std::size_t tissue : tissues)
  {
    const soft_tissue::DeformedDistance::Answer here = bodies_[tissue].at(p);
    if (here.depth > deepest.depth || (std::isnan(deepest.depth) && !std::isnan(here.depth)))
    {
      deepest = here;
      name = info_.tissues[tissue].name;
    }
  }
  if (deepest.depth < -max_distance)
  {
    deepest.depth = -std::numeric_limits<double>::infinity();
    deepest.gradient.setZero();
  }
  response.depths.push_back(deepest.depth);
  response.gradients.push_back(vectorMessage(deepest.gradient));
  response.tissues.push_back(name);
}

}  // namespace soft_tissue_sim
