#include "soft_tissue_sim/node/scene_run.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/node/bag_recorder.h"
#include "soft_tissue_sim/node/csv_recorder.h"
#include "soft_tissue_sim/node/replay.h"
#include "soft_tissue_sim/node/run_summary.h"
#include "soft_tissue_sim/node/scene_loader.h"
#include "soft_tissue_sim/node/wrench_comparison.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;

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
  std::unique_ptr<WrenchComparison> comparison;

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
    if (comparison)
    {
      comparison->add(snapshot);
    }
  }

  void close(const RunOptions& options)
  {
    if (bag)
    {
      bag->close();
    }
    if (csv)
    {
      csv->close();
    }
    if (comparison)
    {
      comparison->writeCsv(options.compare);
    }
  }
};

}  // namespace

bool runScene(const RunOptions& options, const std::atomic<bool>* interrupted)
{
  const Replay replay = readReplay(options);
  soft_tissue::Scene scene = buildScene(replay.config);
  for (const soft_tissue::TissueInfo& tissue : scene.tissues())
  {
    for (const std::string& remark : tissue.remarks)
    {
      std::fprintf(stderr, "note: %s\n", remark.c_str());
    }
  }
  for (const soft_tissue::ToolConfig& tool : scene.config().tools)
  {
    for (const std::string& remark : tool.remarks)
    {
      std::fprintf(stderr, "note: tool '%s': %s\n", tool.name.c_str(), remark.c_str());
    }
  }
  if (!options.load_state.empty())
  {
    scene.loadState(options.load_state);
  }
  soft_tissue::Snapshot start;
  scene.fillSnapshot(start);
  const std::uint64_t done = start.report.step, last = replay.lastStep(done);
  const SceneInfo info(scene);
  Recorders recorders{RunSummary(replay.config, info, replay.poses), nullptr, nullptr, nullptr};
  if (!options.bag_out.empty())
  {
    recorders.bag = std::make_unique<BagRecorder>(options.bag_out, info, options.world_frame,
                                                  replay.poses.start, options.state_rate_hz);
  }
  if (!options.csv.empty())
  {
    recorders.csv = std::make_unique<CsvRecorder>(options.csv, info);
  }
  if (!options.compare.empty())
  {
    recorders.comparison = std::make_unique<WrenchComparison>(readComparison(options, replay));
    recorders.comparison->writeCsv(options.compare);  // a wrong name must not cost a night
  }

  SummaryFile summary_file(options.json);
  if (!options.save_state.empty())
  {
    scene.saveState(options.save_state);  // a wrong name shows now, not after a night
  }
  Progress progress(last - done, options.quiet);
  std::uint64_t reached = done;
  const soft_tissue::Timer timer;
  runReplay(scene, replay, [&](const soft_tissue::Snapshot& snapshot) {
    recorders.write(snapshot);
    reached = snapshot.report.step;
    progress.show(reached - done);
    return interrupted == nullptr || !*interrupted;
  });
  const double wall_s = timer.seconds();

  recorders.close(options);
  if (!options.save_state.empty())
  {
    scene.saveState(options.save_state);
  }
  summary_file.write(recorders.summary.json(wall_s, recorders.comparison.get()));
  if (!options.quiet)
  {
    std::printf("%s%s", recorders.summary.text(wall_s).c_str(),
                recorders.comparison ? recorders.comparison->text().c_str() : "");
  }
  if (!recorders.summary.finite())
  {
    throw Error("scene " + replay.config.file + ": the result is not finite");
  }
  return reached == last;
}

}  // namespace soft_tissue_sim
