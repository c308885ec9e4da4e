#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue_sim
{
/**
 * Gives a tool what its URDF says: the linkage, the collision geometry of the links that it names,
 * how these look, and remarks on looks that are left out.
 *
 * The linkage has the links between those named and the tool frame's, to the root where the tool
 * stands on it. A joint that mimics another follows that one, whose limits are then those that all
 * keep theirs with.
 * Boxes and spheres stay what they are, meshes are taken in metres times their scale. Cylinders
 * (see cylinderMesh()) and meshes that the core can't read (see importMesh()) become an STL file in
 * `scratch`, which must live until the scene is built.
 * @param tool     has `urdf`, and loses it
 * @param scratch  existing folder for generated meshes
 * @throws soft_tissue::Error naming file, link and each mesh that is missing or can't be read, an
 * unknown link, a link without collision geometry, a joint that can't be taken, a jaw of joints
 * that don't move by themselves
 */
void readUrdf(soft_tissue::ToolConfig& tool, const std::string& scratch);

}  // namespace soft_tissue_sim
