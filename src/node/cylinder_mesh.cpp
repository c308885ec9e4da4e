#include "soft_tissue_sim/node/cylinder_mesh.h"

#include <algorithm>
#include <cmath>

namespace soft_tissue_sim
{
namespace
{
constexpr int kSides = 24;

using soft_tissue::Index;
using soft_tissue::TriMesh;
using soft_tissue::Vec3;

/** Adds a ring of corners; @return the number of its first. */
Index addRing(TriMesh& mesh, double radius, double z)
{
  const Index first = static_cast<Index>(mesh.nodes.size());
  for (int side = 0; side < kSides; ++side)
  {
    const double angle = 2.0 * M_PI * side / kSides;
    mesh.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return first;
}

/** Joins two rings by quads of two triangles each, outward if the second ring lies above the first
 * on the wall, further out on the lower cap or further in on the upper cap. */
void joinRings(TriMesh& mesh, Index from, Index to)
{
  for (Index side = 0; side < kSides; ++side)
  {
    const Index next = (side + 1) % kSides;
    mesh.triangles.push_back({from + side, from + next, to + next});
    mesh.triangles.push_back({from + side, to + next, to + side});
  }
}

}  // namespace

TriMesh cylinderMesh(double radius, double length)
{
  const double edge = 2.0 * M_PI * radius / kSides;
  const int cap_rings = kSides / 6;
  const int wall_rings = std::max(1, static_cast<int>(std::ceil(length / (2.0 * edge))));
  const double bottom = -0.5 * length;

  TriMesh mesh;
  mesh.nodes.emplace_back(0.0, 0.0, bottom);
  Index ring = addRing(mesh, radius / cap_rings, bottom);
  for (Index side = 0; side < kSides; ++side)
  {
    mesh.triangles.push_back({0, ring + (side + 1) % kSides, ring + side});
  }
  const auto joinNext = [&](double ring_radius, double z) {
    const Index next = addRing(mesh, ring_radius, z);
    joinRings(mesh, ring, next);
    ring = next;
  };
  for (int i = 2; i <= cap_rings; ++i)
  {
    joinNext(radius * i / cap_rings, bottom);
  }
  for (int i = 1; i <= wall_rings; ++i)
  {
    joinNext(radius, bottom + length * i / wall_rings);
  }
  for (int i = cap_rings - 1; i >= 1; --i)
  {
    joinNext(radius * i / cap_rings, 0.5 * length);
  }
  const Index top = static_cast<Index>(mesh.nodes.size());
  mesh.nodes.emplace_back(0.0, 0.0, 0.5 * length);
  for (Index side = 0; side < kSides; ++side)
  {
    mesh.triangles.push_back({top, ring + side, ring + (side + 1) % kSides});
  }
  return mesh;
}

}  // namespace soft_tissue_sim
