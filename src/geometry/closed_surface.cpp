#include "closed_surface.h"

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** Least sine of a corner that still gives a triangle's normal some correct digits. */
constexpr double kLeastSine = 1e-12;

Index next(Index half_edge)
{
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

Index previous(Index half_edge)
{
  return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
}

Index origin(const SurfaceMesh& mesh, Index half_edge)
{
  return mesh.triangles[half_edge / 3][half_edge % 3];
}

Vec3 doubleArea(const SurfaceMesh& mesh, const Triangle& t)
{
  return (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]);
}

void requireValidTriangles(const SurfaceMesh& mesh, const std::string& what)
{
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    if (!mesh.nodes[i].allFinite())
    {
      throw Error(what + ": node " + std::to_string(i) + " is not finite");
    }
  }
  const Index node_count = static_cast<Index>(mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    const Triangle& t = mesh.triangles[i];
    const std::string place = what + ": triangle " + std::to_string(i);
    for (const Index node : t)
    {
      if (node < 0 || node >= node_count)
      {
        throw Error(place + " names node " + std::to_string(node) + ", must be in [0, " +
                    std::to_string(node_count) + ")");
      }
    }
    const double first = (mesh.nodes[t[1]] - mesh.nodes[t[0]]).norm();
    const double second = (mesh.nodes[t[2]] - mesh.nodes[t[0]]).norm();
    const double third = (mesh.nodes[t[2]] - mesh.nodes[t[1]]).norm();
    const double longest = std::max({first, second, third});
    if (!(doubleArea(mesh, t).norm() > kLeastSine * longest * longest))
    {
      throw Error(place + " has no area");
    }
  }
}

/** Walking around a node must reach all its triangles: else fans touch in a point only. */
void requireSingleFans(const SurfaceMesh& mesh, const std::vector<Index>& twins,
                       const std::string& what)
{
  std::vector<Index> triangle_count(mesh.nodes.size(), 0);
  std::vector<Index> any_half_edge(mesh.nodes.size(), -1);
  for (Index h = 0; h < static_cast<Index>(twins.size()); ++h)
  {
    ++triangle_count[origin(mesh, h)];
    any_half_edge[origin(mesh, h)] = h;
  }
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
  {
    Index walked = 0;
    Index h = any_half_edge[node];
    if (h < 0)
    {
      continue;
    }
    do
    {
      h = twins[previous(h)];
      ++walked;
    } while (h != any_half_edge[node]);
    if (walked != triangle_count[node])
    {
      throw Error(what + ": at node " + std::to_string(node) +
                  " parts of the surface touch in that point only (non-manifold)");
    }
  }
}

double volume6(const SurfaceMesh& mesh)
{
  const Vec3 origin = mesh.nodes[mesh.triangles[0][0]];
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    sum +=
        (mesh.nodes[t[0]] - origin).cross(mesh.nodes[t[1]] - origin).dot(mesh.nodes[t[2]] - origin);
  }
  return sum;
}
}  // namespace

std::vector<Index> closedSurfaceTwins(const SurfaceMesh& mesh, const std::string& what)
{
  if (mesh.triangles.empty())
  {
    throw Error(what + ": the surface has no triangles");
  }
  requireValidTriangles(mesh, what);
  struct HalfEdge
  {
    Index low, high;
    bool forward;
    Index id;
  };
  std::vector<HalfEdge> sorted;
  for (Index h = 0; h < 3 * static_cast<Index>(mesh.triangles.size()); ++h)
  {
    const Index from = origin(mesh, h);
    const Index to = origin(mesh, next(h));
    sorted.push_back({std::min(from, to), std::max(from, to), from < to, h});
  }
  std::sort(sorted.begin(), sorted.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.low != b.low ? a.low < b.low : (a.high != b.high ? a.high < b.high : a.id < b.id);
  });
  std::vector<Index> twins(sorted.size(), -1);
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end)
  {
    while (end < sorted.size() && sorted[end].low == sorted[begin].low &&
           sorted[end].high == sorted[begin].high)
    {
      ++end;
    }
    const std::string place = what + ": edge (" + std::to_string(sorted[begin].low) + ", " +
                              std::to_string(sorted[begin].high) + ")";
    if (end - begin != 2)
    {
      throw Error(place + " belongs to " + std::to_string(end - begin) +
                  (end - begin == 1 ? " triangle (open surface), must be 2"
                                    : " triangles (non-manifold), must be 2"));
    }
    if (sorted[begin].forward == sorted[begin + 1].forward)
    {
      throw Error(place + " runs the same way in triangles " +
                  std::to_string(sorted[begin].id / 3) + " and " +
                  std::to_string(sorted[begin + 1].id / 3) + ": they are oriented oppositely");
    }
    twins[sorted[begin].id] = sorted[begin + 1].id;
    twins[sorted[begin + 1].id] = sorted[begin].id;
  }
  requireSingleFans(mesh, twins, what);
  if (!(volume6(mesh) > 0.0))
  {
    throw Error(what + ": the volume inside is " + std::to_string(volume6(mesh) / 6.0) +
                " m^3, must be > 0 (are its triangles wound inward?)");
  }
  return twins;
}

PseudoNormals pseudoNormals(const SurfaceMesh& mesh, const std::vector<Index>& twins)
{
  PseudoNormals normals;
  normals.nodes.assign(mesh.nodes.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles)
  {
    const Vec3 normal = doubleArea(mesh, t).normalized();
    normals.faces.push_back(normal);
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 forward = mesh.nodes[t[(k + 1) % 3]] - mesh.nodes[t[k]];
      const Vec3 backward = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[k]];
      const double angle = std::atan2(forward.cross(backward).norm(), forward.dot(backward));
      normals.nodes[t[k]] += angle * normal;
    }
  }
  for (std::size_t h = 0; h < twins.size(); ++h)
  {
    const std::size_t other = twins[h] < 0 ? h / 3 : twins[h] / 3;
    normals.edges.push_back((normals.faces[h / 3] + normals.faces[other]).normalized());
  }
  for (Vec3& normal : normals.nodes)
  {
    normal.normalize();
  }
  return normals;
}

bool isConvexSurface(const SurfaceMesh& mesh, const std::vector<Index>& twins,
                     const Points& face_normals)
{
  constexpr double kTolerance = 1e-9;  // of an edge's surroundings
  for (std::size_t h = 0; h < twins.size(); ++h)
  {
    const Vec3 here = mesh.nodes[origin(mesh, static_cast<Index>(h))];
    const Vec3 opposite = mesh.nodes[origin(mesh, previous(twins[h]))] - here;
    if (face_normals[h / 3].dot(opposite) > kTolerance * opposite.norm())
    {
      return false;
    }
  }
  std::vector<bool> reached(mesh.triangles.size(), false);
  std::vector<Index> front = {0};
  reached[0] = true;
  std::size_t count = 0;
  while (!front.empty())
  {
    const Index triangle = front.back();
    front.pop_back();
    ++count;
    for (Index k = 0; k < 3; ++k)
    {
      const Index neighbour = twins[3 * triangle + k] / 3;
      if (!reached[neighbour])
      {
        reached[neighbour] = true;
        front.push_back(neighbour);
      }
    }
  }
  return count == mesh.triangles.size();
}

}  // namespace soft_tissue
