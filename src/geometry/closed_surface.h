#pragma once

#include <array>
#include <string>

#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
/**
 * Per triangle and edge k (corner k to k+1) the half-edge on its other side, numbered
 * 3 * triangle + k.
 *
 * @throws Error, naming `what` and the triangle or node, unless the surface is closed, consistently
 *         oriented, without zero-area triangles or nodes where separate fans touch, and bounds a
 *         positive volume
 */
std::vector<Index> closedSurfaceTwins(const SurfaceMesh& mesh, const std::string& what);

/** Unit outward normals by feature, angle weighted: the sign of a distance follows from them. */
struct PseudoNormals
{
  Points faces;  ///< one a triangle
  Points edges;  ///< 3 * triangle + k: edge from corner k to k+1
  Points nodes;  ///< one a node
};

/** @param twins  of closedSurfaceTwins(); -1 where there is no other side */
PseudoNormals pseudoNormals(const SurfaceMesh& mesh, const std::vector<Index>& twins);

/** Whether the closed surface is one piece without a reflex edge. */
bool isConvexSurface(const SurfaceMesh& mesh, const std::vector<Index>& twins,
                     const Points& face_normals);

}  // namespace soft_tissue
