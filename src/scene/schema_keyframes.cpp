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

void checkTimes(const Item& item, const char* key, const std::vector<PoseKeyframe>& keyframes)
{
  for (std::size_t i = 1; i < keyframes.size(); ++i)
  {
    if (!(keyframes[i].time_s > keyframes[i - 1].time_s))
    {
      const Item before = item.at(key).at(i - 1).at("time_s");
      item.at(key).at(i).at("time_s").rejectValue("must be above " + before.path() + " = " +
                                                  before.written());
    }
  }
}

}  // namespace soft_tissue
