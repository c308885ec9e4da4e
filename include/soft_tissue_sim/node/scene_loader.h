#pragma once

#include <string>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** Reads a scene file; package:// names in it are asked from rospack. @throws soft_tissue::Error */
soft_tissue::SceneConfig loadConfig(const std::string& path);

class ScratchFolder;

/**
 * Gives URDF tools what their URDFs say.
 * @param scratch  for generated meshes; must live until the scene is built
 * @throws soft_tissue::Error naming what is wrong with which file
 */
void readUrdfs(soft_tissue::SceneConfig& config, const ScratchFolder& scratch);

/**
 * Builds the scene, of URDF tools too.
 * @throws soft_tissue::Error naming what is wrong with which file
 */
soft_tissue::Scene buildScene(soft_tissue::SceneConfig config);

}  // namespace soft_tissue_sim
