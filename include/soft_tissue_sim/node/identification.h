#pragma once

#include "soft_tissue_sim/node/run_options.h"

namespace soft_tissue_sim
{
/**
 * Fits numbers of a scene to the forces in a bag, by replaying it until the sum of squares of the
 * differences in force is least, over all tools that the bag has forces of. Prints what it found,
 * with 95 % confidence intervals, and writes it as JSON if asked.
 *
 * Intervals tell how well the bag's forces fix the numbers, taking for granted that the scene is
 * otherwise right: a wrong geometry shifts them by more.
 * @throws soft_tissue::Error if the scene has no such number, the bag no force, or the force does
 * not depend on the number
 */
void identifyParameters(const RunOptions& options);

}  // namespace soft_tissue_sim
