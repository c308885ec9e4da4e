#pragma once

#include "soft_tissue_sim/node/run_options.h"

namespace soft_tissue_sim
{
/**
 * Runs a scene from its file, and a bag if one is given, to its end and writes what was asked for.
 * @throws soft_tissue::Error naming what is wrong with which file
 */
void runScene(const RunOptions& options);

}  // namespace soft_tissue_sim
