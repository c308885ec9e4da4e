#pragma once

#include <geometry_msgs/TransformStamped.h>

#include <string>

namespace soft_tissue_sim
{
/** Why tf would refuse a transform, or should: it tells each time, for as many as come, and throws
 * at stamps beyond the year 2038. Empty: it takes it. */
std::string transformRefusal(const geometry_msgs::TransformStamped& transform);

}  // namespace soft_tissue_sim
