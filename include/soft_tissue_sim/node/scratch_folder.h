#pragma once

#include <string>

namespace soft_tissue_sim
{
/** A new, empty folder among the system's temporary files; it goes, with all in it, with this
 * object. */
class ScratchFolder
{
 public:
  /** @throws soft_tissue::Error if no folder can be made */
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace soft_tissue_sim
