#include "soft_tissue_sim/node/bag_recorder.h"

#include <algorithm>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
const std::string kNamespace = "/sim_node/";
/** What is not in a finished chunk is lost if the process is killed. */
constexpr std::uint32_t kChunkBytes = 128 << 10;
}  // namespace

BagRecorder::BagRecorder(const std::string& path, const SceneInfo& info,
                         const std::string& world_frame, const ros::Time& start,
                         double state_rate_hz)
    : info_(info),
      path_(path),
      world_frame_(world_frame),
      start_(std::max(start, ros::TIME_MIN)),
      state_period_s_(state_rate_hz > 0.0 ? 1.0 / state_rate_hz : 0.0),
      bag_(std::make_unique<rosbag::Bag>())
{
  try
  {
    bag_->open(path, rosbag::bagmode::Write);
    bag_->setCompression(rosbag::compression::LZ4);
    bag_->setChunkThreshold(kChunkBytes);
    writeMeshes();
  }
  catch (const rosbag::BagException& error)
  {
    throw failure(error);
  }
}

BagRecorder::~BagRecorder()
{
  try
  {
    close();
  }
  catch (const soft_tissue::Error&)
  {
    // Another error is on its way already, or nobody asked.
  }
}

/** What to throw when the bag could not be written. Its destructor would write the rest, fail again
 * and end the process: it is let go of. */
soft_tissue::Error BagRecorder::failure(const rosbag::BagException& error)
{
  static_cast<void>(bag_.release());
  return soft_tissue::Error("bag " + path_ + ": can't be written: " + error.what());
}

void BagRecorder::writeMeshes()
{
  for (std::size_t tissue = 0; tissue < info_.tissues.size(); ++tissue)
  {
    bag_->write(kNamespace + info_.tissue_names[tissue] + "/mesh", start_,
                meshMessage(info_, tissue, {start_, world_frame_}));
  }
}

void BagRecorder::write(const soft_tissue::Snapshot& snapshot)
{
  const double time = snapshot.report.time_s;
  const Stamp stamp{start_ + ros::Duration(time), world_frame_};
  try
  {
    constexpr double kRounding = 1.0e-9;  // s
    if (time + kRounding >= next_state_s_)
    {
      next_state_s_ += state_period_s_;
      for (std::size_t tissue = 0; tissue < info_.tissues.size(); ++tissue)
      {
        bag_->write(kNamespace + info_.tissue_names[tissue] + "/state", stamp.time,
                    stateMessage(info_, snapshot, tissue, stamp));
      }
    }
    for (std::size_t tool = 0; tool < info_.tools.size(); ++tool)
    {
      writeTool(tool, snapshot, stamp);
    }
    if (!info_.tissue_pairs.empty())
    {
      bag_->write(kNamespace + "contacts", stamp.time,
                  tissueContactsMessage(info_, snapshot, stamp));
    }
    SimStats stats = statsMessage(snapshot, 0.0, stamp);
    stats.step_ms = 0.0;
    std::fill(stats.stage_ms.begin(), stats.stage_ms.end(), 0.0);
    bag_->write(kNamespace + "stats", stamp.time, stats);
  }
  catch (const rosbag::BagException& error)
  {
    throw failure(error);
  }
}

void BagRecorder::writeTool(std::size_t tool, const soft_tissue::Snapshot& snapshot,
                            const Stamp& stamp)
{
  const std::string& name = info_.tools[tool].name;
  const std::string topic = kNamespace + name;
  const soft_tissue::ToolState& state = snapshot.tools[tool];
  bag_->write(topic + "/measured_cp", stamp.time, toolPoseMessage(state, stamp));
  bag_->write(topic + "/body/measured_cf", stamp.time, bodyWrenchMessage(state, name, stamp));
  bag_->write(topic + "/spatial/measured_cf", stamp.time, spatialWrenchMessage(state, stamp));
  bag_->write(topic + "/contacts", stamp.time, contactsMessage(info_, snapshot, tool, stamp));
  if (!info_.tools[tool].joints.empty())
  {
    bag_->write(topic + "/measured_js", stamp.time, jointMessage(info_.tools[tool], state, stamp));
  }
  if (info_.tool_configs[tool].jaw)
  {
    bag_->write(topic + "/jaw/measured_js", stamp.time,
                jawMessage(info_.tool_configs[tool], state, stamp));
  }
}

void BagRecorder::close()
{
  if (!bag_)
  {
    return;
  }
  try
  {
    bag_->close();
  }
  catch (const rosbag::BagException& error)
  {
    throw failure(error);
  }
}

}  // namespace soft_tissue_sim
