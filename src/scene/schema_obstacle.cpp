#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
void setFile(OctomapConfig& octomap, const std::string& file)
{
  octomap.file = file;
}

void setTopic(OctomapConfig& octomap, const std::string& topic)
{
  octomap.topic = topic;
}

void checkResolution(const Item& item, OctomapConfig& octomap)
{
  if (octomap.topic.empty() && item.has("resolution_m"))
  {
    item.at("resolution_m").rejectValue("is for topic; a file has its own");
  }
  if (!octomap.topic.empty() && !item.has("resolution_m"))
  {
    item.rejectKey("resolution_m", "missing, must be given with topic");
  }
}

const Section<OctomapConfig>& octomapSection()
{
  static const Section<OctomapConfig> section =
      Section<OctomapConfig>("octomap", "Cells of an OctoMap, metres in its own frame.")
          .alternative("file", setFile, file(),
                       "A .bt or .ot file of an OcTree or a ColorOcTree. Relative paths start at "
                       "the scene file.")
          .alternative("topic", setTopic, topic(),
                       "octomap_msgs/Octomap topic below the node's namespace, full or binary, of "
                       "an OcTree or a ColorOcTree: each map takes the place of the one before. "
                       "Until the first comes there is nothing. Tissue that a map takes in is "
                       "pushed out slowly.")
          .optional("resolution_m", &OctomapConfig::resolution_m,
                    number(0.0, 10.0, Ends::open_below),
                    "Edge length of the finest cells of maps from a topic, which needs it; others "
                    "are refused.")
          .optional("depth", &OctomapConfig::depth, integer(1, 16),
                    "Depth of the octree to take cells from: each less doubles them, and those "
                    "with anything occupied in them are.")
          .optional("unknown", &OctomapConfig::unknown_occupied,
                    choice<bool>({{"free", false}, {"occupied", true}}),
                    "What cells are of which the map says nothing, those around the map among "
                    "them.")
          .finally(checkResolution);
  return section;
}
}  // namespace

const Section<ObstacleConfig>& obstacleSection()
{
  static const Section<ObstacleConfig> section =
      Section<ObstacleConfig>("obstacle", "A solid that tissues get out of the way of.")
          .required("name", &ObstacleConfig::name, name(),
                    "Unlike that of any tissue, tool or other obstacle.")
          .required("octomap", &ObstacleConfig::octomap, mapOf(octomapSection()),
                    "The cells it is made of.")
          .optional("pose", &ObstacleConfig::pose, mapOf(poseSection()),
                    "Where the map's frame stands in the world.");
  return section;
}

}  // namespace soft_tissue
