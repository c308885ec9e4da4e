#include "orient_surface.h"

#include <cmath>
#include <utility>
#include <vector>

#include "mesh_scan.h"

namespace soft_tissue
{
namespace
{
/** Triangles connected across edges of exactly two triangles. */
struct Shell
{
  std::vector<Index> triangles;
  bool closed = true;
};

void turn(Triangle& triangle)
{
  std::swap(triangle[1], triangle[2]);
}

bool runsAlong(const Triangle& triangle, Index from, Index to)
{
  for (int k = 0; k < 3; ++k)
  {
    if (triangle[k] == from && triangle[(k + 1) % 3] == to)
    {
      return true;
    }
  }
  return false;
}

/** Walks over the surface from each triangle not yet seen and turns what it meets to agree. */
std::vector<Shell> agreeWithNeighbours(TriMesh& mesh, std::vector<char>& turned)
{
  const Adjacency edges = groupTriangleEdges(static_cast<Index>(mesh.nodes.size()), mesh.triangles);
  std::vector<std::array<Index, 3>> edge_of(mesh.triangles.size());
  for (Index row = 0; row < edges.size(); ++row)
  {
    for (const Index* half = edges.begin(row); half != edges.end(row); ++half)
    {
      edge_of[*half / 3][*half % 3] = row;
    }
  }
  std::vector<Shell> shells;
  std::vector<char> seen(mesh.triangles.size(), 0);
  for (std::size_t seed = 0; seed < seen.size(); ++seed)
  {
    if (seen[seed] != 0)
    {
      continue;
    }
    Shell shell;
    shell.triangles.push_back(static_cast<Index>(seed));
    seen[seed] = 1;
    for (std::size_t i = 0; i < shell.triangles.size(); ++i)
    {
      const Index here = shell.triangles[i];
      for (const Index row : edge_of[here])
      {
        const Index* half = edges.begin(row);
        if (edges.end(row) - half != 2)
        {
          shell.closed = false;
          continue;
        }
        const Index other = half[0] / 3 == here ? half[1] / 3 : half[0] / 3;
        if (seen[other] != 0)
        {
          continue;
        }
        // The edge's ends in the direction `here` runs through it; the neighbour must run against
        // it.
        const Triangle& mine = mesh.triangles[here];
        for (int k = 0; k < 3; ++k)
        {
          const Index a = mine[k];
          const Index b = mine[(k + 1) % 3];
          if (runsAlong(mesh.triangles[other], a, b))
          {
            turn(mesh.triangles[other]);
            turned[other] = 1;
            break;
          }
        }
        seen[other] = 1;
        shell.triangles.push_back(other);
      }
    }
    shells.push_back(std::move(shell));
  }
  return shells;
}

double shellVolume6(const TriMesh& mesh, const Shell& shell)
{
  const Vec3& origin = mesh.nodes[mesh.triangles[shell.triangles[0]][0]];
  double volume6 = 0.0;
  for (const Index i : shell.triangles)
  {
    const Triangle& t = mesh.triangles[i];
    volume6 += signedVolume6(origin, mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]);
  }
  return volume6;
}

/** True if the closed shell goes around the point: its solid angles sum to +-4 pi, else to 0. */
bool surrounds(const TriMesh& mesh, const Shell& shell, const Vec3& point)
{
  double half_angles = 0.0;
  for (const Index i : shell.triangles)
  {
    const Triangle& t = mesh.triangles[i];
    const Vec3 a = mesh.nodes[t[0]] - point;
    const Vec3 b = mesh.nodes[t[1]] - point;
    const Vec3 c = mesh.nodes[t[2]] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    half_angles +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  constexpr double kPi = 3.14159265358979323846;
  return std::abs(half_angles) > kPi;
}
}  // namespace

std::size_t orientSurface(TriMesh& mesh)
{
  std::vector<char> turned(mesh.triangles.size(), 0);
  const std::vector<Shell> shells = agreeWithNeighbours(mesh, turned);
  for (const Shell& shell : shells)
  {
    if (!shell.closed)
    {
      continue;
    }
    const Vec3& point = mesh.nodes[mesh.triangles[shell.triangles[0]][0]];
    bool cavity = false;
    for (const Shell& other : shells)
    {
      const bool inside = &other != &shell && other.closed && surrounds(mesh, other, point);
      cavity = cavity != inside;
    }
    if ((shellVolume6(mesh, shell) < 0.0) != cavity)
    {
      for (const Index i : shell.triangles)
      {
        turn(mesh.triangles[i]);
        turned[i] = turned[i] != 0 ? 0 : 1;
      }
    }
  }
  std::size_t count = 0;
  for (const char was_turned : turned)
  {
    count += was_turned != 0 ? 1 : 0;
  }
  return count;
}

}  // namespace soft_tissue
