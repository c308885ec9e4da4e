#include "soft_tissue_sim/node/replay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/scene_loader.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::SceneConfig;
using soft_tissue::ToolConfig;

soft_tissue::PoseConfig poseConfig(const soft_tissue::Pose& X)
{
  const soft_tissue::Vec3 ypr = X.linear().eulerAngles(2, 1, 0);
  soft_tissue::PoseConfig config;
  config.position_m = X.translation();
  config.rotation_rpy_rad = soft_tissue::Vec3(ypr.z(), ypr.y(), ypr.x());
  return config;
}

void placeJoints(const soft_tissue::JointValues& values, ToolConfig& tool)
{
  const auto zero = soft_tissue::JointValues::Zero(values.size());
  const soft_tissue::JointValues inside = tool.linkage.within(values, zero);
  for (Eigen::Index k = 0; k < values.size(); ++k)
  {
    if (!std::isnan(values[k]))
    {
      tool.initial_joints.push_back(
          {tool.linkage.coordinates()[static_cast<std::size_t>(k)].name, inside[k]});
    }
  }
}

/** Tools and joints start where the bag has them first, instead of jumping there. */
void placeTools(SceneConfig& config, const BagPoses& poses)
{
  for (std::size_t tool = 0; tool < config.tools.size(); ++tool)
  {
    if (poses.tools[tool].first_pose)
    {
      config.tools[tool].initial_pose = poseConfig(*poses.tools[tool].first_pose);
    }
    for (const soft_tissue::JointSeries* values :
         {&poses.tools[tool].joints, &poses.tools[tool].jaw})
    {
      if (!values->empty())
      {
        placeJoints(values->samples.front(), config.tools[tool]);
      }
    }
  }
}

double lastKeyframe(const SceneConfig& config)
{
  double last = 0.0;
  for (const ToolConfig& tool : config.tools)
  {
    for (const soft_tissue::PoseKeyframe& keyframe : tool.pose_source.keyframes)
    {
      last = std::max(last, keyframe.time_s);
    }
    for (const soft_tissue::JointKeyframe& keyframe : tool.joint_source.keyframes)
    {
      last = std::max(last, keyframe.time_s);
    }
  }
  return last;
}

std::uint64_t stepCount(const RunOptions& options, const SceneConfig& config, const BagPoses& poses)
{
  const double duration =
      options.duration_s.value_or(std::max(lastKeyframe(config), poses.length_s));
  if (!options.duration_s && duration == 0.0)
  {
    throw Error("scene " + config.file +
                ": has no key frames and there is no bag: how long is told by --duration");
  }
  constexpr double kRounding = 1.0e-6;
  return static_cast<std::uint64_t>(std::ceil(duration / config.time_step_s - kRounding));
}

/** Sends tools to where the bag has them at the end of a step. */
void setTargets(soft_tissue::Scene& scene, const BagPoses& poses, double begin_s, double end_s)
{
  const double hold_s = PhysicsLoop::Config().watchdog_s;
  for (std::size_t tool = 0; tool < poses.tools.size(); ++tool)
  {
    const BagTool& told = poses.tools[tool];
    if (!told.poses.empty())
    {
      scene.setToolTarget(tool, told.poses.at(end_s));
    }
    if (!told.twists.empty())
    {
      scene.setToolTarget(tool,
                          movedAlong(scene.toolPose(tool), told.twists, begin_s, end_s, hold_s));
    }
    for (const soft_tissue::JointSeries* values : {&told.joints, &told.jaw})
    {
      if (!values->empty())
      {
        scene.setJointTargets(tool, values->at(end_s));
      }
    }
  }
}

}  // namespace

Replay readReplay(const RunOptions& options)
{
  soft_tissue::setThreadCount(options.threads > 0 ? options.threads
                                                  : soft_tissue::usualThreadCount());
  Replay replay;
  replay.config = loadConfig(options.scene);
  replay.scratch = std::make_shared<ScratchFolder>();
  readUrdfs(replay.config, *replay.scratch);  // the bag's joints are those of their linkages
  if (!options.bag_in.empty())
  {
    replay.poses = readBagPoses(options.bag_in, replay.config.tools, options.world_frame);
    placeTools(replay.config, replay.poses);
    std::vector<std::string> warnings = replay.poses.warnings;
    replay.maps = readBagMaps(options.bag_in, replay.config.obstacles, options.world_frame,
                              replay.poses.start, warnings);
    for (const std::string& warning : warnings)
    {
      std::fprintf(stderr, "warning: bag %s: %s\n", options.bag_in.c_str(), warning.c_str());
    }
  }
  replay.config.solver.budget_ms.reset();  // the same bits on a busy machine
  replay.steps = stepCount(options, replay.config, replay.poses);
  replay.from_now = options.duration_s.has_value();
  return replay;
}

void runReplay(soft_tissue::Scene& scene, const Replay& replay,
               const std::function<bool(const soft_tissue::Snapshot&)>& seen)
{
  soft_tissue::Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const std::uint64_t done = snapshot.report.step, last = replay.lastStep(done);
  for (std::uint64_t step = done + 1; step <= last; ++step)
  {
    const double begin = static_cast<double>(step - 1) * replay.config.time_step_s;
    const double end = static_cast<double>(step) * replay.config.time_step_s;
    for (std::size_t k = 0; k < replay.maps.size(); ++k)
    {
      replay.maps[k].apply(step == 1 ? -1.0 : begin, end, k, scene);
    }
    setTargets(scene, replay.poses, begin, end);
    scene.step();
    scene.fillSnapshot(snapshot);
    if (!seen(snapshot))
    {
      return;
    }
  }
}

}  // namespace soft_tissue_sim
