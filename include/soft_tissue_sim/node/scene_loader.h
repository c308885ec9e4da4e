#pragma once

#include <string>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/**
 * Reads a scene file, gives its URDF tools their shapes and builds the scene.
 * @param path  YAML file; package:// names in it are asked from rospack
 * @throws soft_tissue::Error naming what is wrong with which file
 */
soft_tissue::Scene loadScene(const std::string& path);

}  // namespace soft_tissue_sim
