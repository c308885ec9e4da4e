#pragma once

#include <fstream>
#include <string>

#include "soft_tissue_sim/node/scene_info.h"

namespace soft_tissue_sim
{
/** One line a step: time, how the step went, per tool pose and wrench, per pair of tissues the
 * force on its first (world axes, SI units). */
class CsvRecorder
{
 public:
  /** @throws soft_tissue::Error if the file can't be written */
  CsvRecorder(const std::string& path, const SceneInfo& info);

  /** @throws soft_tissue::Error if the disk is full */
  void write(const soft_tissue::Snapshot& snapshot);
  /** @throws soft_tissue::Error if not all could be written */
  void close();

 private:
  void check() const;
  void writeTool(const soft_tissue::ToolState& tool);
  void writePair(const soft_tissue::TissuePairState& pair);

  std::string path_;
  std::ofstream stream_;
};

}  // namespace soft_tissue_sim
