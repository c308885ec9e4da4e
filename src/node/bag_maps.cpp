#include "soft_tissue_sim/node/bag_maps.h"

#include <rosbag/view.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

#include "bag_topics.h"
#include "bag_transforms.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/map_input.h"

namespace soft_tissue_sim
{
void BagMaps::apply(double after, double until, std::size_t obstacle,
                    soft_tissue::Scene& scene) const
{
  const auto next = std::find_if(maps_.rbegin(), maps_.rend(),
                                 [&](const Map& map) { return map.time_s <= until; });
  if (next == maps_.rend() || next->time_s <= after)
  {
    return;
  }
  const soft_tissue::ObstacleConfig& config = scene.config().obstacles[obstacle];
  try
  {
    scene.setObstacle(obstacle,
                      soft_tissue::octomapCells(octomapFrom(*next->message), config.octomap),
                      next->X_WF * config.pose.toPose());
  }
  catch (const soft_tissue::Error& error)
  {
    std::fprintf(stderr, "warning: obstacle '%s': map at %g s left out: %s\n", config.name.c_str(),
                 next->time_s, error.what());
  }
}

std::vector<BagMaps> readBagMaps(const std::string& path,
                                 const std::vector<soft_tissue::ObstacleConfig>& obstacles,
                                 const std::string& world_frame, const ros::Time& start,
                                 std::vector<std::string>& warnings)
{
  std::vector<BagMaps> all(obstacles.size());
  readBag(path, [&](rosbag::Bag& bag) {
    const TopicTypes types = topicTypes(bag);
    std::unique_ptr<BagTransforms> transforms;  // read when first needed
    for (std::size_t k = 0; k < obstacles.size(); ++k)
    {
      const std::string& name = obstacles[k].octomap.topic;
      const std::string topic = name.empty() ? "" : findTopic(types, name, "octomap_msgs/Octomap");
      if (topic.empty())
      {
        continue;
      }
      std::map<std::string, std::size_t> refused;
      rosbag::View view(bag, rosbag::TopicQuery(topic));
      for (const rosbag::MessageInstance& instance : view)
      {
        BagMaps::Map map;
        map.message = instance.instantiate<octomap_msgs::Octomap>();
        if (!map.message)
        {
          ++refused[kOtherDefinition];
          continue;
        }
        const ros::Time stamp =
            map.message->header.stamp.isZero() ? instance.getTime() : map.message->header.stamp;
        const std::string& frame = map.message->header.frame_id;
        if (!frame.empty() && frame != world_frame)
        {
          transforms = transforms ? std::move(transforms) : std::make_unique<BagTransforms>(bag);
          if (!transforms->lookup(world_frame, frame, stamp, map.X_WF).empty() &&
              !transforms->lookup(world_frame, frame, ros::Time(), map.X_WF).empty())
          {
            ++refused["tf in the bag does not lead from frame '" + frame + "' to '" + world_frame +
                      "'"];
            continue;
          }
        }
        map.time_s = stamp > start ? (stamp - start).toSec() : 0.0;
        all[k].maps_.push_back(std::move(map));
      }
      std::stable_sort(all[k].maps_.begin(), all[k].maps_.end(),
                       [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
      for (const auto& [reason, count] : refused)
      {
        warnings.push_back(topic + ": " + std::to_string(count) + " maps left out: " + reason);
      }
    }
  });
  return all;
}

}  // namespace soft_tissue_sim
