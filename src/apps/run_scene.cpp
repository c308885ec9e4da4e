#include <cstdio>
#include <exception>

#include "soft_tissue_sim/node/identification.h"
#include "soft_tissue_sim/node/run_options.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/scene/config.h"

int main(int argc, char** argv)
{
  using namespace soft_tissue_sim;
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
    else if (!options.identify.empty())
    {
      identifyParameters(options);
    }
    else
    {
      runScene(options);
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
