#include "soft_tissue_sim/node/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "soft_tissue_sim/base/error.h"

namespace fs = std::filesystem;

namespace soft_tissue_sim
{
ScratchFolder::ScratchFolder()
{
  std::string pattern = (fs::temp_directory_path() / "soft_tissue_sim_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
  {
    throw soft_tissue::Error("can't make a temporary folder " + pattern + ": " +
                             std::strerror(errno));
  }
  path_ = pattern;
}

ScratchFolder::~ScratchFolder()
{
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace soft_tissue_sim
