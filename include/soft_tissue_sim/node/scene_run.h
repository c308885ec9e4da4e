#pragma once

#include <atomic>

#include "soft_tissue_sim/node/run_options.h"

namespace soft_tissue_sim
{
/**
 * Runs a scene from start to end, without a roscore, and writes what was asked for.
 * @param interrupted  ends it after the step at hand once it is true; may be null
 * @return whether it came to its end
 * @throws soft_tissue::Error if something can't be read or written
 */
bool runScene(const RunOptions& options, const std::atomic<bool>* interrupted = nullptr);

}  // namespace soft_tissue_sim
