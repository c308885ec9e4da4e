#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue_sim
{
/**
 * The collision geometry of one URDF link as shapes in the link's frame.
 *
 * Boxes and spheres stay what they are, meshes are taken in metres times their scale. Cylinders
 * (see cylinderMesh()) and meshes that the core can't read (see importMesh()) become an STL file in
 * `scratch`, which must live until the scene is built.
 * @param urdf     file and link
 * @param scratch  existing folder for generated meshes
 * @throws soft_tissue::Error naming file, link and the mesh that is missing or can't be read, an
 * unknown link, a link without collision geometry
 */
std::vector<soft_tissue::ShapeConfig> shapesFromUrdf(const soft_tissue::UrdfShapeConfig& urdf,
                                                     const std::string& scratch);

}  // namespace soft_tissue_sim
