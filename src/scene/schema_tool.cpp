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

void setTopic(PoseSourceConfig& source, const std::string& topic)
{
  source.kind = PoseSourceConfig::Kind::topic;
  source.name = topic;
}

void setFrame(PoseSourceConfig& source, const std::string& frame)
{
  source.kind = PoseSourceConfig::Kind::tf;
  source.name = frame;
}

void checkPoses(const Item& item, PoseSourceConfig& source)
{
  checkTimes(item, "keyframes", source.keyframes);
}

/** A map, or the bare word of a source that needs no more. */
Kind<PoseSourceConfig> poseSource()
{
  Kind<PoseSourceConfig> kind = mapOf(poseSourceSection());
  kind.read = [map = kind](const Item& item) {
    if (item.isScalar() && item.scalar() == "marker")
    {
      item.rejectValue(kNotAvailable);
    }
    return map.read(item);
  };
  kind.show = [](const PoseSourceConfig& source) { return "{topic: " + source.name + "}"; };
  return kind;
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
}

}  // namespace

const Section<PoseSourceConfig>& poseSourceSection()
{
  static const Section<PoseSourceConfig> section =
      Section<PoseSourceConfig>("pose source", "What moves a tool.")
          .alternative("keyframes", setKeyframes, listOf(mapOf(keyframeSection()), 1),
                       "Poses at times: linear between them (slerp for the rotation), held before "
                       "the first and after the last.")
          .alternative("topic", setTopic, topic(),
                       "geometry_msgs/PoseStamped topic below the tool's namespace.")
          .alternative("tf", setFrame, frame(), "tf frame to follow.")
          .notAvailable("marker", "An interactive marker.")
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
          .finally(checkShapes);
  return section;
}

}  // namespace soft_tissue
