#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace soft_tissue_sim
{
/** What became of the messages of one stream in a bag: each is used or rejected. */
struct StreamCounts
{
  std::string of;     ///< what they tell of a tool: pose, twist, joints or jaw
  std::string topic;  ///< or `/tf`, of which each stamp counts that moves it
  std::size_t messages = 0;
  std::size_t used = 0;
  std::size_t out_of_order = 0;                 ///< recorded after one with a later stamp
  std::size_t beyond_limits = 0;                ///< used, as far as a joint's limits let them
  std::map<std::string, std::size_t> rejected;  ///< by reason
};

}  // namespace soft_tissue_sim
