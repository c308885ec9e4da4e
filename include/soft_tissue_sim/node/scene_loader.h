#pragma once

#include <string>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** Reads a scene file; package:// names in it are asked from rospack. @throws soft_tissue::Error */
soft_tissue::SceneConfig loadConfig(const std::string& path);

/**
 * Gives URDF tools their shapes and builds the scene.
 * @throws soft_tissue::Error naming what is wrong with which file
 */
soft_tissue::Scene buildScene(soft_tissue::SceneConfig config);

}  // namespace soft_tissue_sim
