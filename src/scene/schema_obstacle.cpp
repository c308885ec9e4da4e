#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
const Section<OctomapConfig>& octomapSection()
{
  static const Section<OctomapConfig> section =
      Section<OctomapConfig>("octomap", "Cells of an OctoMap, metres in its own frame.")
          .required("file", &OctomapConfig::file, file(),
                    "A .bt or .ot file of an OcTree or a ColorOcTree. Relative paths start at the "
                    "scene file.")
          .optional("depth", &OctomapConfig::depth, integer(1, 16),
                    "Depth of the octree to take cells from: each less doubles them, and those "
                    "with anything occupied in them are.")
          .optional("unknown", &OctomapConfig::unknown_occupied,
                    choice<bool>({{"free", false}, {"occupied", true}}),
                    "What cells are of which the map says nothing, those around the map among "
                    "them.")
          .notAvailable("topic", "A map that comes as octomap_msgs/Octomap.");
  return section;
}
}  // namespace

const Section<ObstacleConfig>& obstacleSection()
{
  static const Section<ObstacleConfig> section =
      Section<ObstacleConfig>("obstacle", "A solid that stands still; tissues get out of its way.")
          .required("name", &ObstacleConfig::name, name(),
                    "Unlike that of any tissue, tool or other obstacle.")
          .required("octomap", &ObstacleConfig::octomap, mapOf(octomapSection()),
                    "The cells it is made of.")
          .optional("pose", &ObstacleConfig::pose, mapOf(poseSection()),
                    "Where the map's frame stands in the world.");
  return section;
}

}  // namespace soft_tissue
