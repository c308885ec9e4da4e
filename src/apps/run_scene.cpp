#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>

#include "soft_tissue_sim/node/bag_playback.h"
#include "soft_tissue_sim/node/identification.h"
#include "soft_tissue_sim/node/run_options.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/scene/config.h"

namespace
{
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

/** The step at hand is finished and files are closed; a second signal ends the process. */
void interrupt(int signal)
{
  interrupted = true;
  std::signal(signal, SIG_DFL);
}
}  // namespace

int main(int argc, char** argv)
{
  using namespace soft_tissue_sim;
  constexpr int kInterrupted = 130;
  try
  {
    const RunOptions options = parseRunOptions({argv + 1, argv + argc});
    if (options.help)
    {
      std::printf("%s", runUsage().c_str());
    }
    else if (options.describe_schema)
    {
      std::printf("%s", soft_tissue::describeSchema().c_str());
    }
    else if (options.list_inputs)
    {
      printInputs(options);
    }
    else if (!options.identify.empty())
    {
      identifyParameters(options);
    }
    else
    {
      std::signal(SIGINT, interrupt);
      std::signal(SIGTERM, interrupt);
      if (!runScene(options, &interrupted))
      {
        std::fprintf(stderr, "run_scene: interrupted; what was simulated is written\n");
        return kInterrupted;
      }
    }
    return 0;
  }
  catch (const UsageError& error)
  {
    std::fprintf(stderr, "run_scene: %s\n%s", error.what(), runUsage().c_str());
    return 2;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "run_scene: %s\n", error.what());
    return 1;
  }
}
