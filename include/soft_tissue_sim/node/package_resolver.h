#pragma once

#include <string>

namespace soft_tissue_sim
{
/** Folder of a ROS package, asked from rospack, or empty: a soft_tissue::PackageResolver. */
std::string findPackage(const std::string& package);

}  // namespace soft_tissue_sim
