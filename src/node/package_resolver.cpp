#include "soft_tissue_sim/node/package_resolver.h"

#include <ros/package.h>

namespace soft_tissue_sim
{
std::string findPackage(const std::string& package)
{
  return ros::package::getPath(package);
}

}  // namespace soft_tissue_sim
