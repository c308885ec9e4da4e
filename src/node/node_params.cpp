#include "soft_tissue_sim/node/node_params.h"

#include <limits>
#include <sstream>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
constexpr double kMaxMarkerRate = 20.0;  // Hz
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Reads parameters of one node, each checked and with its default kept if it is not set. */
class ParamReader
{
 public:
  explicit ParamReader(const ros::NodeHandle& node) : node_(node) {}

  template <typename T>
  void read(const std::string& name, T& value) const
  {
    if (node_.hasParam(name) && !node_.getParam(name, value))
    {
      throw soft_tissue::Error("parameter " + node_.resolveName(name) + " has the wrong type");
    }
  }

  template <typename T>
  void read(const std::string& name, T& value, T lowest, T highest) const
  {
    read(name, value);
    if (!(value >= lowest && value <= highest))
    {
      std::ostringstream text;
      text << "parameter " << node_.resolveName(name) << " = " << value << ", must be in ["
           << lowest << ", " << highest << "]";
      throw soft_tissue::Error(text.str());
    }
  }

  /** Reads one of a list of words; @return its place in the list. */
  int readChoice(const std::string& name, const std::vector<std::string>& words, int value) const
  {
    std::string word = words[static_cast<std::size_t>(value)];
    read(name, word);
    std::string allowed;
    for (std::size_t i = 0; i < words.size(); ++i)
    {
      if (words[i] == word)
      {
        return static_cast<int>(i);
      }
      allowed += (i > 0 ? ", " : "") + words[i];
    }
    throw soft_tissue::Error("parameter " + node_.resolveName(name) + " = '" + word +
                             "', must be one of " + allowed);
  }

 private:
  const ros::NodeHandle& node_;
};

}  // namespace

NodeParams readNodeParams(const ros::NodeHandle& private_node)
{
  const ParamReader reader(private_node);
  NodeParams params;
  reader.read("scene", params.scene);
  if (params.scene.empty())
  {
    throw soft_tissue::Error("parameter " + private_node.resolveName("scene") +
                             " must name a scene file");
  }
  reader.read("threads", params.threads, 0, 1024);
  reader.read("frame_id", params.world_frame);
  reader.read("publish_clock", params.publish_clock);
  reader.read("watchdog_s", params.loop.watchdog_s, 1.0e-3, kInfinity);
  reader.read("command_wait_s", params.command_wait_s, 0.0, 10.0);
  reader.read("tf_poll_hz", params.tf_poll_hz, 1.0, 1.0e4);
  reader.read("real_time_factor", params.loop.real_time_factor, 0.0, 1.0e3);
  reader.read("paused", params.loop.paused);
  reader.read("state_rate_hz", params.rates.state_hz, 0.0, 1.0e4);
  reader.read("field_rate_hz", params.rates.field_hz, 0.0, 1.0e4);
  reader.read("tool_rate_hz", params.rates.tool_hz, 0.0, 1.0e4);
  reader.read("stats_rate_hz", params.rates.stats_hz, 0.0, 1.0e4);
  reader.read("marker_rate_hz", params.rates.marker_hz, 0.1, kMaxMarkerRate);
  MarkerOptions& markers = params.markers;
  markers.colour_by = static_cast<MarkerOptions::ColourBy>(reader.readChoice(
      "marker_colour", {"displacement", "stress"}, static_cast<int>(markers.colour_by)));
  reader.read("marker_colour_max", markers.colour_max, 0.0, kInfinity);
  markers.slice_axis = reader.readChoice("slice_axis", {"x", "y", "z"}, markers.slice_axis);
  reader.read("slice_fraction", markers.slice_fraction, 0.0, 1.0);
  reader.read("force_scale_m_per_n", markers.force_scale_m_per_n, 0.0, kInfinity);

  params.loop.time_source = params.publish_clock     ? TimeSource::own_clock
                            : ros::Time::isSimTime() ? TimeSource::ros_clock
                                                     : TimeSource::wall;
  return params;
}

}  // namespace soft_tissue_sim
