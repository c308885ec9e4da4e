#pragma once

#include <octomap/OcTree.h>

#include <string>

#include "soft_tissue_sim/geometry/voxel_set.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
/** A map with those cells of a box occupied whose middle is in a solid, and the others free. */
template <typename Tree, typename Inside>
void fillTree(Tree& tree, const CellBox& box, const Inside& inside)
{
  constexpr int kMiddleKey = 32768;
  for (int z = box.low.z(); z < box.high.z(); ++z)
  {
    for (int y = box.low.y(); y < box.high.y(); ++y)
    {
      for (int x = box.low.x(); x < box.high.x(); ++x)
      {
        const Vec3 middle = tree.getResolution() * Vec3(x + 0.5, y + 0.5, z + 0.5);
        tree.updateNode(octomap::OcTreeKey(x + kMiddleKey, y + kMiddleKey, z + kMiddleKey),
                        inside(middle), true);
      }
    }
  }
  tree.updateInnerOccupancy();
}

/** The same, saved as a .bt file. */
template <typename Inside>
std::string savedMap(const ScratchFolder& folder, double size, const CellBox& box,
                     const Inside& inside)
{
  octomap::OcTree tree(size);
  fillTree(tree, box, inside);
  const std::string file = folder.path("map.bt");
  tree.writeBinary(file);
  return file;
}

/** Adds a map "map" that the tissue can touch. */
inline void addMap(SceneConfig& config, const std::string& file, Response response)
{
  ObstacleConfig obstacle;
  obstacle.name = "map";
  obstacle.octomap.file = file;
  config.obstacles.push_back(obstacle);
  addPair(config, "tissue", "map", response);
}

/** Adds an obstacle "map" whose cells come from outside, and that the tissue can touch. */
inline void addLiveMap(SceneConfig& config, double resolution, Response response)
{
  ObstacleConfig obstacle;
  obstacle.name = "map";
  obstacle.octomap.topic = "octomap_in";
  obstacle.octomap.resolution_m = resolution;
  config.obstacles.push_back(obstacle);
  addPair(config, "tissue", "map", response);
}

}  // namespace soft_tissue::test
