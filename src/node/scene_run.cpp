#include "soft_tissue_sim/node/scene_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/bag_recorder.h"
#include "soft_tissue_sim/node/csv_recorder.h"
#include "soft_tissue_sim/node/run_summary.h"
#include "soft_tissue_sim/node/scene_loader.h"
#include "soft_tissue_sim/node/scratch_folder.h"

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
    if (!poses.tools[tool].empty())
    {
      config.tools[tool].initial_pose = poseConfig(poses.tools[tool].samples.front());
    }
    for (const soft_tissue::JointSeries* values : {&poses.joints[tool], &poses.jaws[tool]})
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

/** A bar on standard error, if that is a terminal. */
class Progress
{
 public:
  Progress(std::uint64_t steps, bool quiet) : steps_(steps), shown_(!quiet && isatty(2) != 0) {}

  void show(std::uint64_t step)
  {
    constexpr int kWidth = 40;
    if (!shown_ || (timer_.seconds() < 0.1 && step < steps_))
    {
      return;
    }
    timer_.restart();
    const double part = static_cast<double>(step) / static_cast<double>(steps_);
    const std::string bar(static_cast<std::size_t>(part * kWidth), '#');
    std::fprintf(stderr, "\r[%-*s] %3.0f %%%s", kWidth, bar.c_str(), 100.0 * part,
                 step == steps_ ? "\n" : "");
  }

 private:
  std::uint64_t steps_;
  bool shown_;
  soft_tissue::Timer timer_;
};

/** The summary's file, opened before the run: a wrong name must not cost a night. */
class SummaryFile
{
 public:
  explicit SummaryFile(const std::string& path) : path_(path)
  {
    if (!path.empty())
    {
      stream_.open(path);
      check();
    }
  }

  void write(const std::string& text)
  {
    if (!path_.empty())
    {
      stream_ << text;
      stream_.close();
      check();
    }
  }

 private:
  void check() const
  {
    if (!stream_)
    {
      throw Error("json " + path_ + ": can't be written");
    }
  }

  std::string path_;
  std::ofstream stream_;
};

/** Everything that listens to finished steps. */
struct Recorders
{
  RunSummary summary;
  std::unique_ptr<BagRecorder> bag;
  std::unique_ptr<CsvRecorder> csv;

  void write(const soft_tissue::Snapshot& snapshot)
  {
    summary.add(snapshot);
    if (bag)
    {
      bag->write(snapshot);
    }
    if (csv)
    {
      csv->write(snapshot);
    }
  }
};

void setTargets(soft_tissue::Scene& scene, const BagPoses& poses, double time_s)
{
  for (std::size_t tool = 0; tool < poses.tools.size(); ++tool)
  {
    if (!poses.tools[tool].empty())
    {
      scene.setToolTarget(tool, poses.tools[tool].at(time_s));
    }
    for (const soft_tissue::JointSeries* values : {&poses.joints[tool], &poses.jaws[tool]})
    {
      if (!values->empty())
      {
        scene.setJointTargets(tool, values->at(time_s));
      }
    }
  }
}

}  // namespace

void runScene(const RunOptions& options)
{
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  soft_tissue::setThreadCount(options.threads > 0 ? options.threads : processors);
  SceneConfig config = loadConfig(options.scene);
  const ScratchFolder scratch;
  readUrdfs(config, scratch);
  BagPoses poses;
  if (!options.bag_in.empty())
  {
    poses = readBagPoses(options.bag_in, config.tools, options.world_frame);
    placeTools(config, poses);
    for (const std::string& warning : poses.warnings)
    {
      std::fprintf(stderr, "warning: bag %s: %s\n", options.bag_in.c_str(), warning.c_str());
    }
  }
  config.solver.budget_ms.reset();  // the same bits on a busy machine
  const std::uint64_t steps = stepCount(options, config, poses);
  soft_tissue::Scene scene = buildScene(config);
  for (const soft_tissue::TissueInfo& tissue : scene.tissues())
  {
    for (const std::string& remark : tissue.remarks)
    {
      std::fprintf(stderr, "note: %s\n", remark.c_str());
    }
  }
  for (const ToolConfig& tool : scene.config().tools)
  {
    for (const std::string& remark : tool.remarks)
    {
      std::fprintf(stderr, "note: tool '%s': %s\n", tool.name.c_str(), remark.c_str());
    }
  }
  const SceneInfo info(scene);
  Recorders recorders{RunSummary(config, info), nullptr, nullptr};
  if (!options.bag_out.empty())
  {
    recorders.bag = std::make_unique<BagRecorder>(options.bag_out, info, options.world_frame,
                                                  poses.start, options.state_rate_hz);
  }
  if (!options.csv.empty())
  {
    recorders.csv = std::make_unique<CsvRecorder>(options.csv, info);
  }

  SummaryFile summary_file(options.json);
  Progress progress(steps, options.quiet);
  soft_tissue::Snapshot snapshot;
  const soft_tissue::Timer timer;
  for (std::uint64_t step = 1; step <= steps; ++step)
  {
    setTargets(scene, poses, static_cast<double>(step) * config.time_step_s);
    scene.step();
    scene.fillSnapshot(snapshot);
    recorders.write(snapshot);
    progress.show(step);
  }
  const double wall_s = timer.seconds();

  if (recorders.bag)
  {
    recorders.bag->close();
  }
  if (recorders.csv)
  {
    recorders.csv->close();
  }
  summary_file.write(recorders.summary.json(wall_s));
  if (!options.quiet)
  {
    std::printf("%s", recorders.summary.text(wall_s).c_str());
  }
  if (!recorders.summary.finite())
  {
    throw Error("scene " + config.file + ": the result is not finite");
  }
}

}  // namespace soft_tissue_sim
