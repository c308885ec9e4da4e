#include "soft_tissue_sim/node/marker_input.h"

#include <boost/make_shared.hpp>

#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;

/** Handles of rviz reach this far beyond what they belong to. */
constexpr double kHandles = 1.5;

void addControls(visualization_msgs::InteractiveMarker& marker)
{
  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis)
  {
    InteractiveMarkerControl control;
    // A quarter turn that brings x to this axis.
    control.orientation.w = std::sqrt(0.5);
    control.orientation.x = axis == 0 ? std::sqrt(0.5) : 0.0;
    control.orientation.y = axis == 2 ? -std::sqrt(0.5) : 0.0;
    control.orientation.z = axis == 1 ? std::sqrt(0.5) : 0.0;
    control.name = std::string("push_") + names[axis];
    control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
    marker.controls.push_back(control);
    control.name = std::string("turn_") + names[axis];
    control.interaction_mode = InteractiveMarkerControl::ROTATE_AXIS;
    marker.controls.push_back(control);
  }
}
}  // namespace

MarkerInput::MarkerInput(interactive_markers::InteractiveMarkerServer& server,
                         const std::string& tool, PoseGate& gate, const FrameLookup& frames,
                         const soft_tissue::Pose& X_WT, double size_m)
    : server_(server), tool_(tool), poses_(gate, frames)
{
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = frames.world_frame;
  marker.name = tool;
  marker.description = tool;
  marker.scale = static_cast<float>(kHandles * size_m);
  marker.pose = poseMessage(X_WT);
  addControls(marker);
  server_.insert(marker, [this](const InteractiveMarkerFeedback::ConstPtr& feedback) {
    onFeedback(feedback);
  });
  server_.applyChanges();
}

void MarkerInput::onFeedback(const InteractiveMarkerFeedback::ConstPtr& feedback)
{
  if (feedback->event_type == InteractiveMarkerFeedback::POSE_UPDATE)
  {
    const auto command = boost::make_shared<geometry_msgs::PoseStamped>();
    command->header = feedback->header;
    command->header.stamp = ros::Time();  // rviz has it where it shows it now
    command->pose = feedback->pose;
    poses_.onCommand(command);
  }
}

void MarkerInput::follow(const soft_tissue::Pose& X_WT, std::uint64_t resets)
{
  if (resets != resets_)
  {
    resets_ = resets;
    server_.setPose(tool_, poseMessage(X_WT));
    server_.applyChanges();
  }
}

}  // namespace soft_tissue_sim
