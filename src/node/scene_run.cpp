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

/** Tools start where the bag has them first, instead of jumping there. */
void placeTools(SceneConfig& config, const BagPoses& poses)
{
  for (std::size_t tool = 0; tool < config.tools.size(); ++tool)
  {
    if (!poses.tools[tool].empty())
    {
      config.tools[tool].initial_pose = poseConfig(poses.tools[tool].poses_W.front());
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
  }
  return last;
}

/** @param done  steps taken before this run, which count unless a duration is given */
std::uint64_t stepCount(const RunOptions& options, const SceneConfig& config, const BagPoses& poses,
                        std::uint64_t done)
{
  const double duration =
      options.duration_s.value_or(std::max(lastKeyframe(config), poses.length_s));
  if (!options.duration_s && duration == 0.0)
  {
    throw Error("scene " + config.file +
                ": has no key frames and there is no bag: how long is told by --duration");
  }
  constexpr double kRounding = 1.0e-6;
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(duration / config.time_step_s - kRounding));
  return options.duration_s ? steps : steps - std::min(steps, done);
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
  }
}

}  // namespace

void runScene(const RunOptions& options)
{
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  soft_tissue::setThreadCount(options.threads > 0 ? options.threads : processors);
  SceneConfig config = loadConfig(options.scene);
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
  config.solver.budget_ms.reset();       // the same bits on a busy machine
  stepCount(options, config, poses, 0);  // says what is missing before anything is built
  soft_tissue::Scene scene = buildScene(config);
  soft_tissue::Snapshot snapshot;
  if (!options.load_state.empty())
  {
    scene.loadState(options.load_state);
    scene.fillSnapshot(snapshot);
  }
  const std::uint64_t done = snapshot.report.step;
  const std::uint64_t steps = stepCount(options, config, poses, done);
  for (const soft_tissue::TissueInfo& tissue : scene.tissues())
  {
    for (const std::string& remark : tissue.remarks)
    {
      std::fprintf(stderr, "note: %s\n", remark.c_str());
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
  if (!options.save_state.empty())
  {
    scene.saveState(options.save_state);  // a wrong name shows now, not after a night
  }
  Progress progress(steps, options.quiet);
  const soft_tissue::Timer timer;
  for (std::uint64_t step = 1; step <= steps; ++step)
  {
    setTargets(scene, poses, static_cast<double>(done + step) * config.time_step_s);
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
  if (!options.save_state.empty())
  {
    scene.saveState(options.save_state);
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
