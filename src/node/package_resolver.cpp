#include "soft_tissue_sim/node/package_resolver.h"

#include <ros/package.h>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
std::string findPackage(const std::string& package)
{
  const std::string folder = ros::package::getPath(package);
  if (folder.empty())
  {
    throw soft_tissue::Error("package '" + package +
                             "' is not known to rospack (ROS_PACKAGE_PATH)");
  }
  return folder;
}

}  // namespace soft_tissue_sim
