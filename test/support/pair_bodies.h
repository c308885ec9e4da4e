#pragma once

#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "support/geometry_oracle.h"
#include "support/pair_oracle.h"

namespace soft_tissue::test
{
/** A body whose surface edges and tets pairs are looked for in. */
struct PairBody
{
  explicit PairBody(TetMesh body)
      : mesh(std::move(body)),
        surface(extractBoundary(static_cast<Index>(mesh.nodes.size()), mesh.tets)),
        x(mesh.nodes)
  {}

  ElementSet edges() const
  {
    return {surface.edges[0].data(), 2, static_cast<Index>(surface.edges.size())};
  }
  ElementSet tets() const { return {mesh.tets[0].data(), 4, static_cast<Index>(mesh.tets.size())}; }
  Points moved(const Vec3& shift) const
  {
    Points result = x;
    for (Vec3& p : result)
    {
      p += shift;
    }
    return result;
  }
  static Points shaken(Points positions, RandomGeometry& random, double size)
  {
    for (Vec3& p : positions)
    {
      p += random.point(size);
    }
    return positions;
  }

  TetMesh mesh;
  BoundarySurface surface;
  Points x;
};

}  // namespace soft_tissue::test
