#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "soft_tissue_sim/energy/elasticity.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
namespace test
{
/** Some tets around a common edge with random shapes, no multiple of eight, not at row 0. */
struct Cluster
{
  TetMesh mesh;
  Points x;
  std::vector<TetStiffnessParameters> parameters;
  Index first_node = 3;

  Cluster()
  {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-0.2, 0.2);
    mesh.nodes = {Vec3(0, 0, -1), Vec3(0, 0, 1)};
    const int ring = 11;
    for (int k = 0; k < ring; ++k)
    {
      const double angle = 2.0 * 3.14159265358979 * k / ring;
      mesh.nodes.emplace_back(std::cos(angle), std::sin(angle), uniform(random));
    }
    for (int k = 0; k < ring; ++k)
    {
      mesh.tets.push_back({0, 2 + k, 2 + (k + 1) % ring, 1});
      mesh.tags.push_back(0);
      parameters.push_back({5000.0 * (1.0 + k), 0.04 * k});
    }
    x.assign(first_node, Vec3::Zero());
    for (const Vec3& p : mesh.nodes)
    {
      x.push_back(p + Vec3(uniform(random), uniform(random), uniform(random)));
    }
  }

  Adjacency neighbours() const
  {
    std::vector<Tet> shifted = mesh.tets;
    for (Tet& tet : shifted)
    {
      for (Index& node : tet)
      {
        node += first_node;
      }
    }
    return nodeNeighbours(static_cast<Index>(x.size()), shifted);
  }
};

}  // namespace test
}  // namespace soft_tissue
