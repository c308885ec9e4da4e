#include <algorithm>

#include "schema_sections.h"

namespace soft_tissue
{
Kind<std::vector<JointValue>> jointValues()
{
  constexpr double kMost = 1e3;
  const Kind<double> value = number(-kMost, kMost, Ends::closed);
  Kind<std::vector<JointValue>> kind;
  kind.type = "map of joints to numbers";
  kind.allowed = "within the joints' limits";
  kind.read = [value](const Item& item) {
    if (!item.isMap())
    {
      item.rejectValue("must be a map of joints to numbers");
    }
    std::vector<JointValue> values;
    const std::vector<std::string> joints = item.keys();
    for (const std::string& joint : joints)
    {
      if (std::count(joints.begin(), joints.end(), joint) > 1)
      {
        item.rejectKey(joint, "is there twice");
      }
      values.push_back({joint, value.read(item.at(joint))});
    }
    return values;
  };
  kind.show = [](const std::vector<JointValue>&) { return std::string("{}"); };
  return kind;
}

namespace
{
const Section<JointKeyframe>& jointKeyframeSection()
{
  static const Section<JointKeyframe> section =
      Section<JointKeyframe>("joint key frame", "Where joints are at one time.")
          .required("time_s", &JointKeyframe::time_s, number(0.0, 1e6, Ends::closed),
                    "Simulated time; later than that of the key frame before.")
          .required("values_rad_or_m", &JointKeyframe::values, jointValues(),
                    "The same joints in each key frame.");
  return section;
}

const Section<JawJoint>& jawJointSection()
{
  static const Section<JawJoint> section =
      Section<JawJoint>("jaw joint", "A joint that opens and closes the jaw.")
          .required("joint", &JawJoint::joint, text(), "A joint that moves by itself.")
          .optional("share", &JawJoint::share, factor(10.0),
                    "The joint's value over the jaw's: 0.5 where a jaw's opening angle is that "
                    "between two fingers which turn alike.");
  return section;
}

template <JointSourceConfig::Kind kKind>
void setName(JointSourceConfig& source, const std::string& name)
{
  source.kind = kKind;
  source.name = name;
}

void setKeyframes(JointSourceConfig& source, const std::vector<JointKeyframe>& keyframes)
{
  source.kind = JointSourceConfig::Kind::keyframes;
  source.keyframes = keyframes;
  source.name.clear();
}

void checkAscent(const Item& item, JointSourceConfig& source)
{
  checkTimes(item, "keyframes", source.keyframes);
}
}  // namespace

const Section<JointSourceConfig>& jointSourceSection()
{
  static const Section<JointSourceConfig> section =
      Section<JointSourceConfig>("joint source", "What moves a tool's joints.")
          .alternative("keyframes", setKeyframes, listOf(mapOf(jointKeyframeSection()), 1),
                       "Values at times: linear between them, held before the first and after the "
                       "last.")
          .alternative("topic", setName<JointSourceConfig::Kind::topic>, topic(),
                       "sensor_msgs/JointState topic below the tool's namespace; joints that it "
                       "does not name stay.")
          .alternative("tf", setName<JointSourceConfig::Kind::tf>, prefix(),
                       "The frames of the links, each with this before its name.")
          .finally(checkAscent);
  return section;
}

const Section<JawConfig>& jawSection()
{
  static const Section<JawConfig> section =
      Section<JawConfig>("jaw", "What opens and closes as one.")
          .required("joints", &JawConfig::joints, listOf(mapOf(jawJointSection()), 1),
                    "The joints that move, which no other source moves then.")
          .optional("topic", &JawConfig::topic, topic(),
                    "sensor_msgs/JointState topic below the tool's namespace, with one position: "
                    "the jaw's.");
  return section;
}

}  // namespace soft_tissue
