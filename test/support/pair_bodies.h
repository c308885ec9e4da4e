#pragma once

#include <cmath>
#include <vector>

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

/** Two bodies in each other. */
struct PairMeeting
{
  PairBody a, b;
  Points x_a, x_b;
};

/** Balls, and boxes of cubes that touch along whole faces, one with a bad node. */
inline std::vector<PairMeeting> pairMeetings()
{
  const PairBody ball(makeBall(1.0, 600)), box(makeBox({3, 3, 3}, Vec3::Ones()));
  std::vector<PairMeeting> all = {{ball, ball, ball.x, ball.moved(Vec3(1.5, 0.1, 0.05))},
                                  {box, box, box.x, box.moved(Vec3(1.0, 0.0, 0.0))},
                                  {box, box, box.x, box.moved(Vec3(2.0 / 3.0, 1.0 / 3.0, 0.0))},
                                  {box, box, box.x, box.moved(Vec3(0.5, 0.0, 0.0))}};
  all[3].x_b[5].y() = std::nan("");
  return all;
}

}  // namespace soft_tissue::test
