#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue::studies
{
/** A scene with a feature in one state. */
struct FeatureVariant
{
  std::string state;  ///< "off", "idle" or "in use"
  SceneConfig config;
  int threads = 1;
  bool reads_out = false;  ///< a snapshot is part of each step
};

/** A feature, in states that differ by nothing else; the first one is what the others cost more
 * than. */
struct Feature
{
  std::string name;
  std::vector<FeatureVariant> variants;
};

/**
 * Blocks of 60 x 60 x 30 mm shaken at their bottom, all of them.
 * @param folder  mesh and map files are left here
 * @param cells   along 30 mm, even: 24 cells^3 tets
 * @throws Error if a file can't be written
 */
std::vector<Feature> featureScenes(const std::string& folder, int cells);

}  // namespace soft_tissue::studies
