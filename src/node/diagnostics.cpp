#include "soft_tissue_sim/node/diagnostics.h"

#include "soft_tissue_sim/node/advice.h"

namespace soft_tissue_sim
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/** For the reason why most commands were refused. */
const char* adviceFor(const CommandWatch& watch)
{
  Rejection most = Rejection::none;
  for (int k = 1; k < kRejectionCount; ++k)
  {
    const auto rejection = static_cast<Rejection>(k);
    most = watch.rejected(rejection) > watch.rejected(most) ? rejection : most;
  }
  return adviceFor(most);
}

void reportCommands(const CommandWatch& gate, DiagnosticStatusWrapper& status)
{
  if (gate.stale() && gate.silence() < 0.0)
  {
    status.summary(DiagnosticStatus::WARN, "no command since the clock went back: pose held");
  }
  else if (gate.stale())
  {
    status.summaryf(DiagnosticStatus::WARN, "no command for %.1f s: pose held", gate.silence());
  }
  else if (gate.accepted() == 0 && gate.rejectedInAll() > 0)
  {
    status.summary(DiagnosticStatus::WARN, "no command accepted yet");
  }
  else
  {
    status.summary(DiagnosticStatus::OK,
                   gate.accepted() == 0 ? "waiting for the first command" : "commands come in");
  }
  status.add("advice", gate.rejectedInAll() > 0 ? adviceFor(gate)
                       : gate.stale() ? "is what sends them alive? rostopic hz tells what comes"
                                      : "");
  status.add("accepted", gate.accepted());
  status.add("rejected", gate.rejectedInAll());
  status.add("rejected: not finite", gate.rejected(Rejection::not_finite));
  status.add("rejected: quaternion not unit", gate.rejected(Rejection::not_unit));
  status.add("rejected: too far", gate.rejected(Rejection::too_far));
  status.add("rejected: stamp went back", gate.rejected(Rejection::stamp_went_back));
  status.add("rejected: no such joint", gate.rejected(Rejection::no_joint));
  status.add("rejected: not the joint's motion", gate.rejected(Rejection::other_motion));
  status.add("beyond joint limits", gate.limited());
  status.add("tf failures: unknown frame", gate.rejected(Rejection::unknown_frame));
  status.add("tf failures: no transform at the stamp", gate.rejected(Rejection::no_transform));
}

void reportMaps(const MapInput& maps, DiagnosticStatusWrapper& status)
{
  const std::uint64_t rejected = maps.badMaps() + maps.withoutTransform();
  if (maps.accepted() == 0)
  {
    status.summary(rejected > 0 ? DiagnosticStatus::WARN : DiagnosticStatus::OK,
                   rejected > 0 ? "no map accepted yet" : "waiting for the first map");
  }
  else
  {
    status.summary(DiagnosticStatus::OK, "maps come in");
  }
  status.add("accepted", maps.accepted());
  status.add("rejected", rejected);
  status.add("rejected: not usable", maps.badMaps());
  status.add("tf failures", maps.withoutTransform());
}

}  // namespace

Diagnostics::Diagnostics(const PhysicsLoop& loop, const SceneTopics& scene_topics,
                         const OctomapTopics* octomap_topics,
                         const std::vector<const CommandWatch*>& watches,
                         const std::deque<MapInput>& maps)
    : loop_(loop), scene_topics_(scene_topics), octomap_topics_(octomap_topics)
{
  updater_.setHardwareID("simulation");
  updater_.add("physics", this, &Diagnostics::reportPhysics);
  for (const CommandWatch* watch : watches)
  {
    updater_.add(watch->what() + " commands",
                 [watch](DiagnosticStatusWrapper& status) { reportCommands(*watch, status); });
  }
  for (const MapInput& input : maps)
  {
    updater_.add(input.obstacle() + " maps",
                 [&input](DiagnosticStatusWrapper& status) { reportMaps(input, status); });
  }
}

void Diagnostics::note(const Frame& frame)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  report_ = frame.snapshot.report;
  real_time_factor_ = frame.real_time_factor;
}

void Diagnostics::reportPhysics(DiagnosticStatusWrapper& status)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const LoopCounters& counters = loop_.counters();
  const std::uint64_t missed = counters.missed_deadlines;
  const StepTrouble trouble =
      report_.step > 0 ? troubleOf(report_, missed > reported_missed_) : StepTrouble::none;
  reported_missed_ = missed;
  const bool stands = trouble == StepTrouble::none && counters.paused;
  status.summary(trouble == StepTrouble::none   ? DiagnosticStatus::OK
                 : trouble == StepTrouble::held ? DiagnosticStatus::ERROR
                                                : DiagnosticStatus::WARN,
                 stands ? "paused" : troubleText(trouble));
  status.add("advice", adviceFor(trouble));
  status.add("steps", counters.steps.load());
  status.add("simulated time (s)", report_.time_s);
  status.add("real-time factor", real_time_factor_);
  status.add("missed deadlines", missed);
  status.add("clock jumps back", counters.clock_jumps_back.load());
  status.add("step (ms)", report_.ms.total);
  status.add("worst tetrahedron: det F", report_.min_det_f);
  status.add("deepest penetration (m)", report_.max_penetration_m);
  status.add("residual", report_.residual);
  status.add("converged", static_cast<bool>(report_.converged));
  status.add("out of time", static_cast<bool>(report_.out_of_time));
  status.add("position error (m)", report_.position_error_m);
  status.add("bodies asleep", report_.sleeping);
  status.add("marker arrays built", scene_topics_.markerArraysBuilt());
  if (octomap_topics_ != nullptr)
  {
    status.add("octomaps built", octomap_topics_->mapsBuilt());
  }
}

}  // namespace soft_tissue_sim
