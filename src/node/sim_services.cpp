#include "soft_tissue_sim/node/sim_services.h"

namespace soft_tissue_sim
{
SimServices::SimServices(const ros::NodeHandle& node, PhysicsLoop& loop)
    : loop_(loop), node_(node), spinner_(1, &queue_)
{
  node_.setCallbackQueue(&queue_);
  servers_.push_back(node_.advertiseService("pause_physics", &SimServices::pause, this));
  servers_.push_back(node_.advertiseService("unpause_physics", &SimServices::unpause, this));
  servers_.push_back(node_.advertiseService("step", &SimServices::step, this));
  servers_.push_back(node_.advertiseService("reset_world", &SimServices::reset, this));
  spinner_.start();
}

bool SimServices::pause(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
{
  loop_.setPaused(true);
  return true;
}

bool SimServices::unpause(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
{
  loop_.setPaused(false);
  return true;
}

bool SimServices::step(Step::Request& request, Step::Response& response)
{
  if (request.steps == 0)
  {
    response.message = "steps = 0, must be at least 1";
    return true;
  }
  const std::optional<double> time = loop_.step(request.steps);
  response.success = time.has_value();
  response.time = time.value_or(0.0);
  response.message = time ? "" : "the simulation is running: call pause_physics first";
  return true;
}

bool SimServices::reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
{
  loop_.resetWorld();
  return true;
}

}  // namespace soft_tissue_sim
