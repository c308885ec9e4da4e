#pragma once

#include "soft_tissue_sim/node/command_check.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** What is wrong with a step, the worst first. */
enum class StepTrouble
{
  none,
  held,           ///< it failed, the last good state was kept
  late,           ///< it was not done when the clock wanted it
  inverted,       ///< tets are turned inside out
  not_converged,  ///< it ended far from balance, with time left
};

/** @param late  deadlines were missed lately */
StepTrouble troubleOf(const soft_tissue::StepReport& report, bool late);

/** What is wrong, for people. */
const char* troubleText(StepTrouble trouble);

/** What to change; empty for none. */
const char* adviceFor(StepTrouble trouble);
/** What to change where the commands come from; empty for none. */
const char* adviceFor(Rejection rejection);

}  // namespace soft_tissue_sim
