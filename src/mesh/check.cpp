#include "soft_tissue_sim/mesh/check.h"

#include <algorithm>
#include <cmath>

#include "mesh_scan.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "soft_tissue_sim/base/union_find.h"

namespace soft_tissue
{
namespace
{
/** Widens [low, high], in degrees, by the tet's six dihedral angles. */
void addDihedrals(const TetMesh& mesh, const Tet& tet, double& low, double& high)
{
  Vec3 normals[4];
  for (Index k = 0; k < 4; ++k)
  {
    const Triangle face = tetFace(tet, k);
    const Vec3& a = mesh.nodes[face[0]];
    normals[k] = (mesh.nodes[face[1]] - a).cross(mesh.nodes[face[2]] - a).normalized();
  }
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i + 1; j < 4; ++j)
    {
      const double cosine = std::max(-1.0, std::min(1.0, -normals[i].dot(normals[j])));
      const double angle = kDegrees * std::acos(cosine);
      low = std::min(low, angle);
      high = std::max(high, angle);
    }
  }
}

void checkShapes(const TetMesh& mesh, MeshCheck& check)
{
  check.min_quality = mesh.tets.empty() ? 0.0 : 1.0;
  check.min_dihedral_deg = mesh.tets.empty() ? 0.0 : 180.0;
  for (const Tet& tet : mesh.tets)
  {
    const Vec3& a = mesh.nodes[tet[0]];
    const Vec3& b = mesh.nodes[tet[1]];
    const Vec3& c = mesh.nodes[tet[2]];
    const Vec3& d = mesh.nodes[tet[3]];
    check.volume_m3 += signedVolume6(a, b, c, d) / 6.0;
    const double quality = tetQuality(a, b, c, d);
    const bool degenerate = hasZeroVolume(mesh.nodes, tet);
    check.degenerate += degenerate ? 1 : 0;
    check.inverted += !degenerate && quality < 0.0 ? 1 : 0;
    check.slivers += quality < kSliverQuality ? 1 : 0;
    check.min_quality = std::min(check.min_quality, quality);
    addDihedrals(mesh, tet, check.min_dihedral_deg, check.max_dihedral_deg);
  }
}

void checkFaces(const TetMesh& mesh, MeshCheck& check)
{
  const auto node_count = static_cast<Index>(mesh.nodes.size());
  const Adjacency faces = groupTetFaces(node_count, mesh.tets);
  UnionFind parts(mesh.tets.size());
  for (Index row = 0; row < faces.size(); ++row)
  {
    const Index* face = faces.begin(row);
    check.overshared_faces += faces.end(row) - face > 2 ? 1 : 0;
    for (const Index* other = face + 1; other < faces.end(row); ++other)
    {
      parts.join(*face / 4, *other / 4);
    }
  }
  check.parts = parts.sets();
}

/** Counts the sets of triangles that hang together by nodes. */
std::size_t countShells(Index node_count, const std::vector<Triangle>& triangles)
{
  UnionFind nodes(node_count);
  for (const Triangle& triangle : triangles)
  {
    nodes.join(triangle[0], triangle[1]);
    nodes.join(triangle[0], triangle[2]);
  }
  const std::vector<char> used = usedNodes(node_count, triangles);
  return nodes.sets() - std::count(used.begin(), used.end(), 0);
}

/** Counts the nodes whose triangles fall into several fans. */
std::size_t countPinchedNodes(Index node_count, const std::vector<Triangle>& triangles,
                              const Adjacency& edges)
{
  // A fan joins the corners that meet at a node along an edge of that node.
  UnionFind corners(3 * triangles.size());
  const auto cornerOf = [&](Index triangle, Index node) {
    const Triangle& t = triangles[triangle];
    return 3 * triangle + (t[0] == node ? 0 : t[1] == node ? 1 : 2);
  };
  for (Index row = 0; row < edges.size(); ++row)
  {
    const Index first = *edges.begin(row);
    for (const Index* half = edges.begin(row) + 1; half < edges.end(row); ++half)
    {
      for (const int end : {0, 1})
      {
        const Index node = triangles[first / 3][(first % 3 + end) % 3];
        corners.join(cornerOf(first / 3, node), cornerOf(*half / 3, node));
      }
    }
  }
  std::vector<int> fans(node_count, 0);
  for (std::size_t corner = 0; corner < 3 * triangles.size(); ++corner)
  {
    if (corners.find(static_cast<Index>(corner)) == static_cast<Index>(corner))
    {
      ++fans[triangles[corner / 3][corner % 3]];
    }
  }
  return std::count_if(fans.begin(), fans.end(), [](int count) { return count > 1; });
}
}  // namespace

double tetQuality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const double sum2 = (b - a).squaredNorm() + (c - a).squaredNorm() + (d - a).squaredNorm() +
                      (c - b).squaredNorm() + (d - b).squaredNorm() + (d - c).squaredNorm();
  const double rms = std::sqrt(sum2 / 6.0);
  return rms > 0.0 ? std::sqrt(2.0) * signedVolume6(a, b, c, d) / (rms * rms * rms) : 0.0;
}

SurfaceTopology surfaceTopology(Index node_count, const std::vector<Triangle>& all_triangles)
{
  std::vector<Triangle> triangles;
  for (const Triangle& t : all_triangles)
  {
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
    {
      triangles.push_back(t);
    }
  }
  SurfaceTopology topology;
  const Adjacency edges = groupTriangleEdges(node_count, triangles);
  for (Index row = 0; row < edges.size(); ++row)
  {
    const Index* half = edges.begin(row);
    const auto sharing = edges.end(row) - half;
    topology.open_edges += sharing == 1 ? 1 : 0;
    topology.non_manifold_edges += sharing > 2 ? 1 : 0;
    if (sharing == 2 && triangles[half[0] / 3][half[0] % 3] == triangles[half[1] / 3][half[1] % 3])
    {
      ++topology.flipped_edges;
    }
  }
  topology.parts = countShells(node_count, triangles);
  topology.non_manifold_vertices = countPinchedNodes(node_count, triangles, edges);
  return topology;
}

MeshCheck checkMesh(const TetMesh& mesh)
{
  const auto node_count = static_cast<Index>(mesh.nodes.size());
  MeshCheck check;
  check.nodes = mesh.nodes.size();
  check.tets = mesh.tets.size();
  check.size_m = boxSize(mesh.nodes);
  checkShapes(mesh, check);
  check.duplicate_nodes = countRepeated(firstAtSamePlace(mesh.nodes));
  check.duplicate_tets = countRepeated(firstWithSameNodes(node_count, mesh.tets));
  const std::vector<char> used = usedNodes(mesh.nodes.size(), mesh.tets);
  check.orphan_nodes = std::count(used.begin(), used.end(), 0);
  checkFaces(mesh, check);
  const BoundarySurface boundary = extractBoundary(node_count, mesh.tets);
  check.boundary_triangles = boundary.triangles.size();
  check.boundary = surfaceTopology(node_count, boundary.triangles);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    ++check.tags[mesh.tags.empty() ? 0 : mesh.tags[t]];
  }
  return check;
}

SurfaceCheck checkSurface(const TriMesh& mesh)
{
  const auto node_count = static_cast<Index>(mesh.nodes.size());
  SurfaceCheck check;
  check.nodes = mesh.nodes.size();
  check.triangles = mesh.triangles.size();
  check.size_m = boxSize(mesh.nodes);
  for (const Triangle& triangle : mesh.triangles)
  {
    const Vec3& origin = mesh.nodes[mesh.triangles[0][0]];
    const Vec3& a = mesh.nodes[triangle[0]];
    const Vec3& b = mesh.nodes[triangle[1]];
    const Vec3& c = mesh.nodes[triangle[2]];
    check.area_m2 += 0.5 * (b - a).cross(c - a).norm();
    check.volume_m3 += signedVolume6(origin, a, b, c) / 6.0;
    check.zero_area += hasZeroArea(mesh.nodes, triangle) ? 1 : 0;
  }
  check.duplicate_nodes = countRepeated(firstAtSamePlace(mesh.nodes));
  check.duplicate_triangles = countRepeated(firstWithSameNodes(node_count, mesh.triangles));
  const std::vector<char> used = usedNodes(mesh.nodes.size(), mesh.triangles);
  check.orphan_nodes = std::count(used.begin(), used.end(), 0);
  check.topology = surfaceTopology(node_count, mesh.triangles);
  return check;
}

bool SurfaceCheck::watertight() const
{
  return triangles > 0 && zero_area == 0 && duplicate_triangles == 0 && topology.open_edges == 0 &&
         topology.flipped_edges == 0 && topology.non_manifold_edges == 0 &&
         topology.non_manifold_vertices == 0 && volume_m3 > 0.0;
}

}  // namespace soft_tissue
