#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soft_tissue_sim/energy/elasticity.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
/** A soft body as its configuration says, before it has a place among the scene's nodes. Vertices
 * of tets are numbered along halvingOrder(), for the sake of loops over nodes. */
struct SoftBodyModel
{
  TissueInfo info;
  std::vector<Index> file_node;  ///< N: each node's number in TissueInfo as the scene shows it
  std::vector<std::vector<Index>> moved;  ///< nodes of each SoftBodyConfig::keyframes
};

struct TissueModel : SoftBodyModel
{
  ElementKind element = ElementKind::tet4;        ///< never automatic
  std::optional<QuadraticTetMesh> quadratic;      ///< its elements, where they are not info.rest's
  std::vector<MaterialModel> laws;                ///< per element
  std::vector<TetStiffnessParameters> stiffness;  ///< per element
  std::vector<double> densities;                  ///< per element, kg/m^3
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

/** What the model knows of its body, with nodes numbered as in the file of its mesh. */
TissueInfo inFileOrder(const SoftBodyModel& model);

/**
 * Adds its masses, and the masses by which gravity pulls at its nodes, kg.
 *
 * These differ for quadratic tets alone: uniform forces then act as the shape functions say. But a
 * tissue that nothing holds has to fall without being deformed, so gravity takes its masses.
 */
void addMasses(const TissueModel& model, Index first_node, std::vector<double>& masses,
               std::vector<double>& load_masses);

/** Nodes that share an element with each node. */
Adjacency elementNeighbours(const TissueModel& model);

/** "<scene file>: list[index]", for messages. */
std::string item(const SceneConfig& config, const char* list, std::size_t index);

/** The length that this share of a body's surface edges are no longer than, m. */
double edgeLength(const TissueInfo& tissue, double share);

/** Radius of about the largest ball that fits in a body, m: the largest distance of a node or of a
 * tet's middle from the boundary. */
double innerRadius(const TetMesh& rest, const BoundarySurface& surface);

/** Solids of a tool that always keep their places to each other. */
struct ToolPartModel
{
  std::string name;
  std::size_t link = 0;  ///< of the tool's linkage: their frame
  RigidBodyShape shape;
};

/** The tool's solids. @throws Error for a bad mesh or size */
std::vector<ToolPartModel> makeToolParts(const ToolConfig& config, const std::string& where);

}  // namespace soft_tissue
