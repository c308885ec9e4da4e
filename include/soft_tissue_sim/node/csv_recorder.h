#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** One line a step: time, how the step went, and per tool pose and wrench (world axes, SI units).
 */
class CsvRecorder
{
 public:
  /** @throws soft_tissue::Error if the file can't be written */
  CsvRecorder(const std::string& path, const std::vector<soft_tissue::ToolInfo>& tools);

  void write(const soft_tissue::Snapshot& snapshot);
  /** @throws soft_tissue::Error if not all could be written */
  void close();

 private:
  void writeTool(const soft_tissue::ToolState& tool);

  std::string path_;
  std::ofstream stream_;
};

}  // namespace soft_tissue_sim
