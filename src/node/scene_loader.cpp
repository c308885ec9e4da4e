#include "soft_tissue_sim/node/scene_loader.h"

#include <filesystem>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/package_resolver.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "soft_tissue_sim/node/urdf_tool.h"

namespace soft_tissue_sim
{
soft_tissue::SceneConfig loadConfig(const std::string& path)
{
  return soft_tissue::loadSceneConfig(path, &findPackage);
}

void readUrdfs(soft_tissue::SceneConfig& config, const ScratchFolder& scratch)
{
  for (soft_tissue::ToolConfig& tool : config.tools)
  {
    if (!tool.urdf)
    {
      continue;
    }
    try
    {
      const std::string folder = scratch.path() + "/" + tool.name;
      std::filesystem::create_directories(folder);
      readUrdf(tool, folder);
    }
    catch (const soft_tissue::Error& error)
    {
      throw soft_tissue::Error("scene " + config.file + ": tool '" + tool.name +
                               "': " + error.what());
    }
  }
}

soft_tissue::Scene buildScene(soft_tissue::SceneConfig config)
{
  const ScratchFolder scratch;
  readUrdfs(config, scratch);
  return soft_tissue::Scene(config);
}

}  // namespace soft_tissue_sim
