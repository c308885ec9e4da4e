#pragma once

#include <string>
#include <vector>

namespace soft_tissue
{
/** How a program ended. */
struct ProgramResult
{
  bool started = false;    ///< false if it could not be run at all, e.g. not installed
  bool timed_out = false;  ///< true if it was ended after the time limit
  int exit_code = -1;      ///< -1 if it did not exit by itself
  std::string output;      ///< the end of what it wrote to stdout and stderr
};

/** Runs a program found in PATH without a shell, its working folder being `folder`. */
ProgramResult runProgram(const std::vector<std::string>& words, const std::string& folder,
                         double timeout_s);

/** A folder that is removed with all it holds at the end of its scope. */
class TemporaryFolder
{
 public:
  /** @throws Error if none can be made */
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace soft_tissue
