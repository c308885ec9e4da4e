#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
/** A tissue as its configuration says, before it has a place among the scene's nodes. */
struct TissueModel
{
  TissueInfo info;
  std::vector<TetStiffnessParameters> stiffness;  ///< per tet
  std::vector<double> densities;                  ///< per tet, kg/m^3
};

/**
 * Loads, places and checks one tissue.
 * @param where  "<scene file>: tissues[0]", for messages
 * @throws Error for a bad mesh, a fixed box without nodes, a region without tets
 */
TissueModel makeTissue(const TissueConfig& config, const std::string& where);

/** The tool's solids in its own frame. @throws Error for a bad mesh or size */
RigidBodyShape makeToolShape(const ToolConfig& config, const std::string& where);

}  // namespace soft_tissue
