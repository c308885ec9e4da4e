#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
/** A soft body as its configuration says, before it has a place among the scene's nodes. */
struct SoftBodyModel
{
  TissueInfo info;
  std::vector<std::vector<Index>> moved;  ///< nodes of each SoftBodyConfig::keyframes
};

struct TissueModel : SoftBodyModel
{
  std::vector<TetStiffnessParameters> stiffness;  ///< per tet
  std::vector<double> densities;                  ///< per tet, kg/m^3
};

/**
 * Loads, places and checks one tissue.
 * @param where  "<scene file>: tissues[0]", for messages
 * @throws Error for a bad mesh, a fixed box without nodes, a region without tets
 */
TissueModel makeTissue(const TissueConfig& config, const std::string& where);

/**
 * Loads, places and checks one membrane.
 * @throws Error for a bad mesh or one with tets, a fixed box without nodes
 */
SoftBodyModel makeMembrane(const MembraneConfig& config, const std::string& where);

/** "<scene file>: list[index]", for messages. */
std::string item(const SceneConfig& config, const char* list, std::size_t index);

/** The length that this share of a body's surface edges are no longer than, m. */
double edgeLength(const TissueInfo& tissue, double share);

/** Radius of about the largest ball that fits in a body, m: the largest distance of a node or of a
 * tet's middle from the boundary. */
double innerRadius(const TetMesh& rest, const BoundarySurface& surface);

/** The tool's solids in its own frame. @throws Error for a bad mesh or size */
RigidBodyShape makeToolShape(const ToolConfig& config, const std::string& where);

}  // namespace soft_tissue
