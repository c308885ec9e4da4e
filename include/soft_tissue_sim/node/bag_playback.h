#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/node/run_options.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue_sim
{
/** A topic in a bag that a node can be played from. */
struct PlayedTopic
{
  std::string recorded;
  std::string name;  ///< below the node, or with a slash before it as it is
};

/**
 * The topics of a bag that a replay without a node reads, and as what a node of the same scene
 * takes them.
 * @param config    with its URDFs read
 * @param warnings  gets those that a node has no way in for
 * @throws soft_tissue::Error if the file is not a readable bag, or two topics claim to be the same
 */
std::vector<PlayedTopic> playedTopics(const std::string& path,
                                      const soft_tissue::SceneConfig& config,
                                      std::vector<std::string>& warnings);

/** Prints them as RECORDED:=NAME, one a line, and warnings on standard error. @throws
 * soft_tissue::Error */
void printInputs(const RunOptions& options);

}  // namespace soft_tissue_sim
