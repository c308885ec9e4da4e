#pragma once

#include <mutex>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue_sim
{
/** Holds the newest pose command for one tool between the callbacks and the physics thread. */
class CommandSlot
{
 public:
  /** Leaves a command, in place of one that was not taken yet. */
  void put(const soft_tissue::Pose& X_WT)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    X_WT_ = X_WT;
    fresh_ = true;
  }

  /** Takes the command out if there is a new one. */
  bool take(soft_tissue::Pose& X_WT)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (fresh_)
    {
      X_WT = X_WT_;
      fresh_ = false;
      return true;
    }
    return false;
  }

 private:
  std::mutex mutex_;
  soft_tissue::Pose X_WT_ = soft_tissue::Pose::Identity();
  bool fresh_ = false;
};

}  // namespace soft_tissue_sim
