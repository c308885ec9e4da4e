#pragma once

#include <urdf_model/link.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"
#include "soft_tissue_sim/scene/tool_config.h"

namespace soft_tissue_sim
{
/** Where shapes made here are written: names of their own that still tell what they were made
 * from. */
struct Scratch
{
  std::string folder;
  std::size_t number = 0;  ///< of the next

  std::string save(const std::string& made_from, const soft_tissue::TriMesh& mesh);
};

/** A geometry as a solid. @param folder  where relative mesh paths start
 * @throws soft_tissue::Error for a mesh that is missing or can't be read */
soft_tissue::ShapeGeometry urdfShape(const urdf::Geometry& geometry, const std::string& folder,
                                     Scratch& scratch);

/** A visual geometry; its place on which link is for others to say. @throws soft_tissue::Error for
 * a mesh that is missing */
soft_tissue::VisualConfig urdfVisual(const urdf::Visual& visual, const std::string& folder);

}  // namespace soft_tissue_sim
