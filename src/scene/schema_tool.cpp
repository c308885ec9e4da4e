#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
void setKeyframes(PoseSourceConfig& source, const std::vector<PoseKeyframe>& keyframes)
{
  source.kind = PoseSourceConfig::Kind::keyframes;
  source.keyframes = keyframes;
  source.name.clear();
}

template <PoseSourceConfig::Kind kKind>
void setName(PoseSourceConfig& source, const std::string& name)
{
  source.kind = kKind;
  source.name = name;
}

void setMarker(PoseSourceConfig& source, bool)
{
  source.kind = PoseSourceConfig::Kind::marker;
  source.name.clear();
}

void setBase(PoseSourceConfig& source, const PoseConfig& pose)
{
  source.kind = PoseSourceConfig::Kind::base;
  source.base_pose = pose;
  source.name.clear();
}

void checkPoses(const Item& item, PoseSourceConfig& source)
{
  checkTimes(item, "keyframes", source.keyframes);
}

/** A map, or the bare word of the source that needs no more. */
Kind<PoseSourceConfig> poseSource()
{
  Kind<PoseSourceConfig> kind = mapOf(poseSourceSection());
  kind.type = "map or marker";
  kind.read = [map = kind](const Item& item) {
    if (item.isScalar() && item.scalar() == "marker")
    {
      PoseSourceConfig source;
      setMarker(source, true);
      return source;
    }
    return map.read(item);
  };
  kind.show = [](const PoseSourceConfig& source) { return "{topic: " + source.name + "}"; };
  return kind;
}

Kind<JointSourceConfig> jointSource()
{
  Kind<JointSourceConfig> kind = mapOf(jointSourceSection());
  kind.show = [](const JointSourceConfig& source) { return "{topic: " + source.name + "}"; };
  return kind;
}

/** Yes; nothing else can be said of what is there or is not. */
Kind<bool> yes()
{
  Kind<bool> kind = boolean();
  kind.allowed = "true";
  kind.read = [any = kind](const Item& item) {
    if (!any.read(item))
    {
      item.rejectValue("must be true, or left out");
    }
    return true;
  };
  return kind;
}

Kind<std::optional<double>> greatest()
{
  return maybe(number(0.0, 1000.0, Ends::open_below), "none", true);
}

void setShapes(ToolConfig& tool, const std::vector<ToolShapeConfig>& shapes)
{
  for (const ToolShapeConfig& shape : shapes)
  {
    if (shape.urdf)
    {
      tool.urdf = shape.urdf;
    }
    else
    {
      tool.shapes.push_back(shape.solid);
    }
  }
}

void checkShapes(const Item& item, ToolConfig& tool)
{
  const Item shape = item.at("shape");
  if (tool.urdf && shape.isList() && shape.size() > 1)
  {
    shape.reject("must have no other shape beside urdf");
  }
  for (const char* key : {"initial_joints_rad_or_m", "joint_source", "jaw"})
  {
    if (!tool.urdf && item.has(key))
    {
      item.rejectKey(key, "needs a shape from a urdf, which has joints");
    }
  }
  if (!tool.urdf && tool.pose_source.kind == PoseSourceConfig::Kind::base)
  {
    item.at("pose_source").at("base").reject("needs a shape from a urdf, which has a root");
  }
}

}  // namespace

const Section<PoseSourceConfig>& poseSourceSection()
{
  static const Section<PoseSourceConfig> section =
      Section<PoseSourceConfig>("pose source", "What moves a tool.")
          .alternative("keyframes", setKeyframes, listOf(mapOf(keyframeSection()), 1),
                       "Poses at times: linear between them (slerp for the rotation), held before "
                       "the first and after the last.")
          .alternative("topic", setName<PoseSourceConfig::Kind::topic>, topic(),
                       "geometry_msgs/PoseStamped topic below the tool's namespace.")
          .alternative("twist", setName<PoseSourceConfig::Kind::twist>, topic(),
                       "geometry_msgs/TwistStamped topic below the tool's namespace: how fast the "
                       "tool frame goes, until commands stop.")
          .alternative("tf", setName<PoseSourceConfig::Kind::tf>, frame(), "tf frame to follow.")
          .alternative("marker", setMarker, yes(), "An interactive marker, dragged in rviz.")
          .alternative("base", setBase, mapOf(poseSection()),
                       "The URDF's joints: its root link stands here in the world, and they move "
                       "the tool frame as well.")
          .finally(checkPoses);
  return section;
}

const Section<ToolConfig>& toolSection()
{
  static const Section<ToolConfig> section =
      Section<ToolConfig>("tool", "A rigid body that something outside the simulation moves.")
          .required(
              "name", &ToolConfig::name, name(),
              "Its ROS namespace; unlike that of any other tissue or tool, and not tissue_pairs.")
          .required("shape", setShapes, listOf(mapOf(toolShapeSection()), 1, true),
                    "Its solid, or several that move as one.")
          .optional("initial_pose", &ToolConfig::initial_pose, mapOf(poseSection()),
                    "Where the tool frame waits for its first command; key frames override it.")
          .optional("pose_source", &ToolConfig::pose_source, poseSource(), "What moves it.")
          .optional("max_speed_m_per_s", &ToolConfig::max_speed_m_per_s, greatest(),
                    "Speed of the tool frame's origin at most, however far off a command is; key "
                    "frames may be faster.")
          .optional("max_turn_rate_rad_per_s", &ToolConfig::max_turn_rate_rad_per_s, greatest(),
                    "The same of its turning.")
          .optional("initial_joints_rad_or_m", &ToolConfig::initial_joints, jointValues(),
                    "Where joints of a urdf wait for their first command; those not named as near "
                    "to zero as their limits let them.")
          .optional("joint_source", &ToolConfig::joint_source, jointSource(),
                    "What moves the joints of a urdf, within its limits and no faster than its "
                    "velocities; key frames may be faster.")
          .optional("jaw", &ToolConfig::jaw, maybe(mapOf(jawSection()), "none", true),
                    "Joints of a urdf that a command of their own moves.")
          .finally(checkShapes);
  return section;
}

}  // namespace soft_tissue
