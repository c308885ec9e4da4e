#pragma once

#include <vector>

#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
/** A tool's surface as contact quadrature, tool frame. */
struct ToolSurface
{
  Points nodes;                   ///< m
  std::vector<double> node_area;  ///< a third of each node's triangles, m^2
  std::vector<Edge> edges;        ///< each once, smaller node first
  std::vector<double> edge_area;  ///< a third of each edge's triangles, m^2
};

/**
 * Samples a tool as finely as contact wants: edges of half its inner radius, between about 100 and
 * 2000 nodes where its shapes let us choose; what one part hides inside another is left out.
 */
ToolSurface sampleToolSurface(const RigidBodyShape& tool);

}  // namespace soft_tissue
