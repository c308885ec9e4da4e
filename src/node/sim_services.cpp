#include "soft_tissue_sim/node/sim_services.h"

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
/** Where a node's relative paths begin is nobody's choice. */
void checkPath(const std::string& path)
{
  if (path.empty() || path[0] != '/')
  {
    throw soft_tissue::Error("path = '" + path + "', must be absolute");
  }
}

template <typename Response>
void tell(const PhysicsLoop::Moment& moment, Response& response)
{
  response.step = moment.step;
  response.time = moment.time_s;
  response.state_hash = moment.state_hash;
}

std::optional<double> given(double value)
{
  return std::isnan(value) ? std::nullopt : std::make_optional(value);
}
}  // namespace

SimServices::SimServices(const ros::NodeHandle& node, const SceneInfo& info, bool owns_clock,
                         PhysicsLoop& loop, ProgressTopic& progress)
    : info_(info),
      loop_(loop),
      progress_(progress),
      step_node_(node),
      step_spinner_(1, &step_queue_),
      node_(node),
      spinner_(1, &queue_)
{
  step_node_.setCallbackQueue(&step_queue_);
  servers_.push_back(step_node_.advertiseService("step", &SimServices::step, this));
  node_.setCallbackQueue(&queue_);
  servers_.push_back(node_.advertiseService("pause_physics", &SimServices::pause, this));
  servers_.push_back(node_.advertiseService("unpause_physics", &SimServices::unpause, this));
  servers_.push_back(node_.advertiseService("cancel", &SimServices::cancel, this));
  servers_.push_back(node_.advertiseService("reset_world", &SimServices::reset, this));
  if (owns_clock)
  {
    servers_.push_back(
        node_.advertiseService("reset_simulation", &SimServices::resetSimulation, this));
  }
  servers_.push_back(node_.advertiseService("save_state", &SimServices::save, this));
  servers_.push_back(node_.advertiseService("load_state", &SimServices::load, this));
  servers_.push_back(node_.advertiseService("set_material", &SimServices::setMaterial, this));
  spinner_.start();
  step_spinner_.start();
}

/** Does what may be refused, and tells of it as of a task. */
template <typename Act, typename Response>
void SimServices::answer(const char* name, const Act& act, Response& response)
{
  ProgressTopic::Task task = progress_.begin(name, 0);
  try
  {
    act();
    response.success = true;
    task.end(Progress::DONE);
  }
  catch (const soft_tissue::Error& error)
  {
    response.message = error.what();
    task.end(Progress::FAILED, error.what());
  }
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
  ProgressTopic::Task task = progress_.begin("step", request.steps);
  try
  {
    const PhysicsLoop::Stepped stepped =
        loop_.step(request.steps, [&task](std::uint32_t done) { task.advance(done); });
    response.success = stepped.steps == request.steps;
    response.time = stepped.time_s;
    if (!response.success)
    {
      response.message = "cancelled after " + std::to_string(stepped.steps) + " of " +
                         std::to_string(request.steps) + " steps";
    }
    task.end(response.success ? Progress::DONE : Progress::CANCELLED, response.message);
  }
  catch (const soft_tissue::Error& error)
  {
    response.message = error.what();
    task.end(Progress::FAILED, error.what());
  }
  return true;
}

bool SimServices::cancel(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  response.success = loop_.cancelSteps();
  response.message = response.success ? "" : "no steps are under way that were asked for";
  return true;
}

bool SimServices::reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
{
  loop_.resetWorld();
  return true;
}

bool SimServices::resetSimulation(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
{
  loop_.resetSimulation();
  return true;
}

bool SimServices::save(SaveState::Request& request, SaveState::Response& response)
{
  answer(
      "save_state",
      [&] {
        checkPath(request.path);
        tell(loop_.saveState(request.path), response);
      },
      response);
  return true;
}

bool SimServices::load(LoadState::Request& request, LoadState::Response& response)
{
  answer(
      "load_state",
      [&] {
        checkPath(request.path);
        tell(loop_.loadState(request.path), response);
      },
      response);
  return true;
}

bool SimServices::setMaterial(SetMaterial::Request& request, SetMaterial::Response& response)
{
  const auto found =
      std::find(info_.tissue_names.begin(), info_.tissue_names.end(), request.tissue);
  if (found == info_.tissue_names.end())
  {
    std::string names;
    for (const std::string& name : info_.tissue_names)
    {
      names += (names.empty() ? "" : ", ") + name;
    }
    response.message = "tissue = '" + request.tissue + "', must be one of: " + names;
    return true;
  }
  soft_tissue::MaterialChange change;
  change.region = request.has_region ? std::make_optional<int>(request.region) : std::nullopt;
  change.young_modulus_pa = given(request.young_modulus);
  change.poisson_ratio = given(request.poisson_ratio);
  change.density_kg_per_m3 = given(request.density);
  change.stiffening = given(request.stiffening);
  answer(
      "set_material", [&] { loop_.setMaterial(found - info_.tissue_names.begin(), change); },
      response);
  return true;
}

}  // namespace soft_tissue_sim
