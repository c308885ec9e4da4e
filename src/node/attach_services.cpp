#include "soft_tissue_sim/node/attach_services.h"

#include <algorithm>
#include <functional>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
/** The place of a name among others; nothing if it is empty. */
std::optional<std::size_t> placeOf(const char* what, const std::string& name,
                                   const std::vector<std::string>& all)
{
  if (name.empty())
  {
    return std::nullopt;
  }
  const auto found = std::find(all.begin(), all.end(), name);
  if (found == all.end())
  {
    std::string names;
    for (const std::string& one : all)
    {
      names += (names.empty() ? "" : ", ") + one;
    }
    throw soft_tissue::Error(std::string(what) + " = '" + name + "', must be one of: " + names);
  }
  return static_cast<std::size_t>(found - all.begin());
}
}  // namespace

AttachServices::AttachServices(const ros::NodeHandle& node, const SceneInfo& info,
                               PhysicsLoop& loop)
    : info_(info), loop_(loop), node_(node), spinner_(1, &queue_)
{
  node_.setCallbackQueue(&queue_);
  for (std::size_t tool = 0; tool < info.tools.size(); ++tool)
  {
    const std::string& name = info.tools[tool].name;
    const boost::function<bool(Attach::Request&, Attach::Response&)> on_attach =
        [this, tool](Attach::Request& request, Attach::Response& response) {
          attach(tool, request, response);
          return true;
        };
    const boost::function<bool(Detach::Request&, Detach::Response&)> on_detach =
        [this, tool](Detach::Request& request, Detach::Response& response) {
          detach(tool, request, response);
          return true;
        };
    servers_.push_back(node_.advertiseService(name + "/attach", on_attach));
    servers_.push_back(node_.advertiseService(name + "/detach", on_detach));
  }
  spinner_.start();
}

void AttachServices::attach(std::size_t tool, const Attach::Request& request,
                            Attach::Response& response)
{
  try
  {
    soft_tissue::AttachRequest asked;
    asked.tool = tool;
    asked.part = partOf(tool, request.part);
    asked.tissue = tissueOf(request.tissue);
    asked.reach_m = request.reach;
    if (request.stiffness != 0.0)
    {
      asked.stiffness_pa_per_m = request.stiffness;
    }
    response.nodes = static_cast<std::uint32_t>(loop_.attach(asked));
    response.success = response.nodes > 0;
    response.message = response.success ? "" : "no free node within reach that is not tied already";
  }
  catch (const soft_tissue::Error& error)
  {
    response.message = error.what();
  }
}

void AttachServices::detach(std::size_t tool, const Detach::Request& request,
                            Detach::Response& response)
{
  try
  {
    response.nodes = static_cast<std::uint32_t>(loop_.detach(tool, partOf(tool, request.part)));
    response.success = true;
  }
  catch (const soft_tissue::Error& error)
  {
    response.message = error.what();
  }
}

std::optional<std::size_t> AttachServices::partOf(std::size_t tool, const std::string& name) const
{
  std::vector<std::string> names;
  for (const soft_tissue::ToolPartInfo& part : info_.tools[tool].parts)
  {
    names.push_back(part.name);
  }
  return placeOf("part", name, names);
}

std::optional<std::size_t> AttachServices::tissueOf(const std::string& name) const
{
  return placeOf("tissue", name, info_.tissue_names);
}

}  // namespace soft_tissue_sim
