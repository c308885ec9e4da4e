#pragma once

#include <string>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue_sim
{
/** Whether the core reads no such file, going by the name's ending: Collada, glTF, 3DS, ... */
bool needsImport(const std::string& file);

/**
 * Reads all triangles of a file that the core can't read, by Assimp.
 *
 * A Collada file's unit and the transforms of its nodes are applied, its up axis is not: in ROS
 * coordinates are meant as they are written.
 * @return corners of every triangle, in metres; corners that triangles share come several times
 * @throws soft_tissue::Error naming the file and why it can't be read
 */
soft_tissue::TriMesh importMesh(const std::string& file);

}  // namespace soft_tissue_sim
