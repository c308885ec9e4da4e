#include "soft_tissue_sim/node/run_options.h"

#include <cmath>
#include <functional>
#include <map>
#include <sstream>

namespace soft_tissue_sim
{
namespace
{
double parseNumber(const std::string& option, const std::string& text, double lowest)
{
  std::size_t used = 0;
  double value = 0.0;
  try
  {
    value = std::stod(text, &used);
  }
  catch (const std::exception&)
  {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value) || value < lowest)
  {
    throw UsageError(option + " " + text + ": must be a number not below " +
                     std::to_string(lowest));
  }
  return value;
}

int parseCount(const std::string& option, const std::string& text)
{
  const double value = parseNumber(option, text, 0.0);
  if (value != std::floor(value) || value > 1024.0)
  {
    throw UsageError(option + " " + text + ": must be a whole number up to 1024");
  }
  return static_cast<int>(value);
}

std::vector<std::string> splitNames(const std::string& text)
{
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');)
  {
    names.push_back(name);
  }
  return names;
}

}  // namespace

std::string runUsage()
{
  return "usage: run_scene SCENE.yaml [options]\n"
         "Runs a scene as fast as possible, without a roscore.\n\n"
         "  --duration S         simulated seconds; default: the bag's length or the last key "
         "frame\n"
         "  --bag-in FILE        what moves tools, and obstacles' maps: topics named "
         ".../<tool>/servo_cp\n"
         "                       and so on, else .../<tool>/measured_cp and so on, and tf\n"
         "  --list-inputs        print those topics and what a node takes them as, and end\n"
         "  --bag-out FILE       meshes, states, poses, forces, contacts and stats\n"
         "  --state-rate HZ      most tissue states a simulated second in that bag; 0: every step\n"
         "  --csv FILE           one line a step\n"
         "  --json FILE          summary of the run\n"
         "  --compare FILE       forces simulated and those in the bag, "
         ".../<tool>/body/measured_cf\n"
         "                       or .../spatial/measured_cf, as CSV; errors in the summary\n"
         "  --tare S             takes the mean of the bag's forces in its first S seconds for "
         "zero\n"
         "  --identify NAMES     fits numbers of the scene to those forces, e.g.\n"
         "                       liver/young_modulus_pa,liver/probe/stiffness_pa_per_m\n"
         "  --load-state FILE    go on from the state of a run of the same scene\n"
         "  --save-state FILE    keep the state at the end\n"
         "  --frame-id FRAME     name of the world frame (world)\n"
         "  --threads N          threads a step may use; 0: one per processor, up to 8\n"
         "  --quiet              print nothing but errors\n"
         "  --describe-schema    print all keys of a scene file, and end\n"
         "  --help               print this, and end\n\n"
         "exit status: 0 done, 1 failed, 2 wrong usage, 130 interrupted, with all files closed\n";
}

RunOptions parseRunOptions(const std::vector<std::string>& arguments)
{
  RunOptions options;
  const std::map<std::string, std::function<void(const std::string&, const std::string&)>> valued =
      {{"--duration", [&](const auto& name,
                          const auto& text) { options.duration_s = parseNumber(name, text, 0.0); }},
       {"--bag-in", [&](const auto&, const auto& text) { options.bag_in = text; }},
       {"--bag-out", [&](const auto&, const auto& text) { options.bag_out = text; }},
       {"--csv", [&](const auto&, const auto& text) { options.csv = text; }},
       {"--compare", [&](const auto&, const auto& text) { options.compare = text; }},
       {"--tare",
        [&](const auto& name, const auto& text) { options.tare_s = parseNumber(name, text, 0.0); }},
       {"--identify", [&](const auto&, const auto& text) { options.identify = splitNames(text); }},
       {"--json", [&](const auto&, const auto& text) { options.json = text; }},
       {"--load-state", [&](const auto&, const auto& text) { options.load_state = text; }},
       {"--save-state", [&](const auto&, const auto& text) { options.save_state = text; }},
       {"--frame-id", [&](const auto&, const auto& text) { options.world_frame = text; }},
       {"--state-rate",
        [&](const auto& name, const auto& text) {
          options.state_rate_hz = parseNumber(name, text, 0.0);
        }},
       {"--threads",
        [&](const auto& name, const auto& text) { options.threads = parseCount(name, text); }}};
  const std::map<std::string, bool*> flags = {{"--quiet", &options.quiet},
                                              {"--list-inputs", &options.list_inputs},
                                              {"--describe-schema", &options.describe_schema},
                                              {"--help", &options.help},
                                              {"-h", &options.help}};
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& argument = arguments[i];
    const auto flag = flags.find(argument);
    const auto option = valued.find(argument);
    if (flag != flags.end())
    {
      *flag->second = true;
    }
    else if (option != valued.end())
    {
      if (i + 1 == arguments.size())
      {
        throw UsageError(argument + " needs a value");
      }
      option->second(argument, arguments[++i]);
    }
    else if (!argument.empty() && argument[0] == '-')
    {
      throw UsageError("unknown option " + argument);
    }
    else if (!options.scene.empty())
    {
      throw UsageError("more than one scene: " + options.scene + " and " + argument);
    }
    else
    {
      options.scene = argument;
    }
  }
  if (options.scene.empty() && !options.help && !options.describe_schema)
  {
    throw UsageError("a scene file is needed");
  }
  if (options.bag_in.empty() && (!options.compare.empty() || !options.identify.empty()))
  {
    throw UsageError("--compare and --identify need forces from --bag-in");
  }
  if (options.bag_in.empty() && options.list_inputs)
  {
    throw UsageError("--list-inputs needs --bag-in");
  }
  if (!options.identify.empty() &&
      !(options.bag_out.empty() && options.csv.empty() && options.compare.empty()))
  {
    throw UsageError("--identify runs the scene many times: it writes --json alone");
  }
  return options;
}

}  // namespace soft_tissue_sim
