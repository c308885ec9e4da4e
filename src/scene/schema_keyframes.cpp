#include "schema_sections.h"

namespace soft_tissue
{
const Section<PoseKeyframe>& keyframeSection()
{
  static const Section<PoseKeyframe> section =
      Section<PoseKeyframe>("key frame", "Where a frame is at one time.")
          .required("time_s", &PoseKeyframe::time_s, number(0.0, 1e6, Ends::closed),
                    "Simulated time; later than that of the key frame before.")
          .required(
              "position_m", [](PoseKeyframe & k) -> auto& { return k.pose.position_m; }, position(),
              "Origin of the frame in the world.")
          .optional(
              "rotation_rpy_rad", [](PoseKeyframe & k) -> auto& { return k.pose.rotation_rpy_rad; },
              rotation(), "Roll, pitch, yaw of the frame about the world's x, y, z.");
  return section;
}

}  // namespace soft_tissue
