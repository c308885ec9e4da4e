#pragma once

#include <string>

namespace soft_tissue_sim
{
/**
 * Path of an existing file that a URDF names by package://, file://, an absolute or a relative
 * name.
 * @param uri     the name as the URDF writes it
 * @param folder  where relative names start
 * @throws soft_tissue::Error saying which part of the path is missing, and which name differs from
 * it only in upper and lower case
 */
std::string resolveResource(const std::string& uri, const std::string& folder);

}  // namespace soft_tissue_sim
