#include "soft_tissue_sim/scene/config.h"

#include "schema_sections.h"

namespace soft_tissue
{
SceneConfig loadSceneConfig(const std::string& path, PackageResolver resolver)
{
  const Document document = readDocument(path, resolver);
  SceneConfig config = sceneSection().read(Item(document));
  config.file = path;
  return config;
}

}  // namespace soft_tissue
