#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/field/distance_field.h"
#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
/** A body with everything a field needs, which lives as long as the body stays where it is. */
struct FieldBody
{
  explicit FieldBody(TetMesh tet_mesh)
      : mesh(std::move(tet_mesh)),
        surface(extractBoundary(static_cast<Index>(mesh.nodes.size()), mesh.tets)),
        neighbours(nodeNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.tets))
  {}
  FieldBody(const FieldBody&) = delete;
  FieldBody& operator=(const FieldBody&) = delete;

  FieldTopology topology() const { return {&surface, &neighbours}; }
  std::unique_ptr<DistanceField> field(const std::string& method = "cffm") const
  {
    return makeDistanceField(method, topology());
  }

  TetMesh mesh;
  BoundarySurface surface;
  Adjacency neighbours;
};

/** The oracle: each node's distance to the nearest of all boundary triangles, one after the other.
 */
inline std::vector<double> exactDepths(const FieldBody& body, const Points& x)
{
  std::vector<double> depths;
  for (const Vec3& p : x)
  {
    depths.push_back(bruteForceDistance(p, x, body.surface.triangles));
  }
  return depths;
}

/** How far a field lies above the exact one. */
struct FieldErrors
{
  double least = 0.0;           ///< m; below zero only by rounding
  double median = 0.0;          ///< m, over inner nodes
  double largest = 0.0;         ///< m
  double wrong_fraction = 0.0;  ///< of inner nodes, more than rounding off
  double deepest = 0.0;         ///< m, largest exact depth
};

inline FieldErrors fieldErrors(const FieldBody& body, const std::vector<double>& depth,
                               const std::vector<double>& exact)
{
  FieldErrors result;
  std::vector<double> errors;
  for (std::size_t node = 0; node < depth.size(); ++node)
  {
    result.deepest = std::max(result.deepest, exact[node]);
    if (body.surface.node_slot[node] < 0)
    {
      errors.push_back(depth[node] - exact[node]);
    }
  }
  if (errors.empty())
  {
    return result;
  }
  std::sort(errors.begin(), errors.end());
  result.least = errors.front();
  result.median = errors[errors.size() / 2];
  result.largest = errors.back();
  const double rounding = 1e-12 * result.deepest;
  const auto wrong =
      std::count_if(errors.begin(), errors.end(), [&](double e) { return e > rounding; });
  result.wrong_fraction = static_cast<double>(wrong) / static_cast<double>(errors.size());
  return result;
}

}  // namespace soft_tissue::test
