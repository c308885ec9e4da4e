#pragma once

#include <string>

namespace soft_tissue_sim
{
/**
 * Folder of a ROS package, asked from rospack: a soft_tissue::PackageResolver.
 * @throws soft_tissue::Error if rospack does not know the package
 */
std::string findPackage(const std::string& package);

}  // namespace soft_tissue_sim
