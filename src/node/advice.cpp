#include "soft_tissue_sim/node/advice.h"

namespace soft_tissue_sim
{
StepTrouble troubleOf(const soft_tissue::StepReport& report, bool late)
{
  return report.held                                ? StepTrouble::held
         : late                                     ? StepTrouble::late
         : !(report.min_det_f > 0.0)                ? StepTrouble::inverted
         : !report.converged && !report.out_of_time ? StepTrouble::not_converged
                                                    : StepTrouble::none;
}

const char* troubleText(StepTrouble trouble)
{
  switch (trouble)
  {
    case StepTrouble::held:
      return "the last step failed: last good state held";
    case StepTrouble::late:
      return "slower than the clock: deadlines missed";
    case StepTrouble::inverted:
      return "tetrahedra are turned inside out";
    case StepTrouble::not_converged:
      return "the last step ended far from balance";
    case StepTrouble::none:
      break;
  }
  return "running";
}

const char* adviceFor(StepTrouble trouble)
{
  switch (trouble)
  {
    case StepTrouble::held:
      return "tools move too far in a step: a smaller time_step_s, max_speed_m_per_s of the tool, "
             "or less stiffness of "
             "contact";
    case StepTrouble::late:
      return "solver: {budget_ms} ends steps in time; a coarser mesh, a larger tolerance or sleep "
             "makes them shorter; "
             "~real_time_factor below 1 gives them longer";
    case StepTrouble::inverted:
      return "tissue is pressed or pulled farther than its mesh can follow: move tools less far, "
             "or take a finer mesh "
             "there";
    case StepTrouble::not_converged:
      return "a larger max_iterations, a smaller time_step_s, or a larger tolerance if the "
             "residual is good enough";
    case StepTrouble::none:
      break;
  }
  return "";
}

const char* adviceFor(Rejection rejection)
{
  switch (rejection)
  {
    case Rejection::not_finite:
      return "look for NaN where the commands are computed, as in kinematics without a solution";
    case Rejection::not_unit:
      return "normalise quaternions before they are sent; a message that was not filled in has "
             "none";
    case Rejection::too_far:
      return "positions are in metres; is frame_id the frame that they are in?";
    case Rejection::unknown_frame:
      return "let a node broadcast the frame, or leave frame_id empty for the world's; ~frame_id "
             "names the world";
    case Rejection::no_transform:
      return "send commands and transforms by one clock, or raise ~command_wait_s";
    case Rejection::stamp_went_back:
      return "does more than one node send to this topic, or a clock differ between machines?";
    case Rejection::no_joint:
      return "names must be those of the URDF's joints, with one position each";
    case Rejection::other_motion:
      return "are the frames those of the same URDF? joint_source: {tf: PREFIX} names what stands "
             "before the links";
    case Rejection::none:
      break;
  }
  return "";
}

}  // namespace soft_tissue_sim
