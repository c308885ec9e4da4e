#include "soft_tissue_sim/mesh/repair.h"

#include <cmath>
#include <utility>

#include "mesh_scan.h"
#include "orient_surface.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"

namespace soft_tissue
{
namespace
{
/** Adds "<count> <what>" to the sentences unless the count is zero. */
void tell(std::vector<std::string>& sentences, std::size_t count, const std::string& what)
{
  if (count > 0)
  {
    sentences.push_back(std::to_string(count) + " " + what);
  }
}

/** Lets all elements name the first of several nodes at one place. @return how many nodes that
 * frees */
template <std::size_t K>
std::size_t mergeNodes(const Points& nodes, std::vector<std::array<Index, K>>& elements)
{
  const std::vector<Index> first = firstAtSamePlace(nodes);
  for (auto& element : elements)
  {
    for (Index& node : element)
    {
      node = first[node];
    }
  }
  return countRepeated(first);
}

/** Drops nodes no element names. @return how many */
template <std::size_t K>
std::size_t dropUnusedNodes(Points& nodes, std::vector<std::array<Index, K>>& elements)
{
  const std::vector<char> used = usedNodes(nodes.size(), elements);
  std::vector<Index> place(nodes.size(), -1);
  std::size_t next = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    if (used[i] != 0)
    {
      nodes[next] = nodes[i];
      place[i] = static_cast<Index>(next++);
    }
  }
  const std::size_t dropped = nodes.size() - next;
  nodes.resize(next);
  for (auto& element : elements)
  {
    for (Index& node : element)
    {
      node = place[node];
    }
  }
  return dropped;
}

/** Keeps the elements (and their tags, if any) that are marked. @return how many were dropped */
template <typename Element>
std::size_t keep(const std::vector<char>& marked, std::vector<Element>& elements,
                 std::vector<int>* tags)
{
  std::size_t next = 0;
  for (std::size_t i = 0; i < marked.size(); ++i)
  {
    if (marked[i] != 0)
    {
      elements[next] = elements[i];
      if (tags != nullptr && !tags->empty())
      {
        (*tags)[next] = (*tags)[i];
      }
      ++next;
    }
  }
  elements.resize(next);
  if (tags != nullptr && !tags->empty())
  {
    tags->resize(next);
  }
  return marked.size() - next;
}

template <std::size_t K>
std::size_t dropRepeated(Index node_count, std::vector<std::array<Index, K>>& elements,
                         std::vector<int>* tags)
{
  const std::vector<Index> first = firstWithSameNodes(node_count, elements);
  std::vector<char> marked(elements.size());
  for (std::size_t i = 0; i < marked.size(); ++i)
  {
    marked[i] = first[i] == static_cast<Index>(i) ? 1 : 0;
  }
  return keep(marked, elements, tags);
}

void tellTopology(const SurfaceTopology& topology, const std::string& where, RepairReport& report)
{
  tell(report.left, topology.open_edges, "open edges" + where);
  tell(report.left, topology.flipped_edges,
       "edges" + where + " whose triangles disagree in winding");
  tell(report.left, topology.non_manifold_edges, "non-manifold edges" + where);
  tell(report.left, topology.non_manifold_vertices, "non-manifold vertices" + where);
}
}  // namespace

RepairReport repairMesh(TetMesh& mesh)
{
  RepairReport report;
  const auto node_count = static_cast<Index>(mesh.nodes.size());
  const std::size_t merged = mergeNodes(mesh.nodes, mesh.tets);
  tell(report.done, merged, "nodes at the place of an earlier one merged with it");
  std::vector<char> marked;
  for (const Tet& tet : mesh.tets)
  {
    marked.push_back(hasZeroVolume(mesh.nodes, tet) ? 0 : 1);
  }
  tell(report.done, keep(marked, mesh.tets, &mesh.tags), "tets without volume dropped");
  tell(report.done, dropRepeated(node_count, mesh.tets, &mesh.tags), "duplicate tets dropped");
  std::size_t turned = 0;
  for (Tet& tet : mesh.tets)
  {
    const Points& x = mesh.nodes;
    if (signedVolume6(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]) < 0.0)
    {
      std::swap(tet[2], tet[3]);
      ++turned;
    }
  }
  tell(report.done, turned, "left-handed tets turned");
  const std::size_t unused = dropUnusedNodes(mesh.nodes, mesh.tets) - merged;
  tell(report.done, unused, "nodes in no tet dropped");
  if (mesh.tets.empty())
  {
    throw Error("repair: no tet is left");
  }
  const MeshCheck check = checkMesh(mesh);
  tell(report.left, check.slivers, "slivers (q < 0.1)");
  tell(report.left, check.overshared_faces, "faces of three or more tets");
  tell(report.left, check.parts - 1, "parts beside the first, connected to it by no face");
  tellTopology(check.boundary, " on the boundary", report);
  return report;
}

RepairReport repairSurface(TriMesh& mesh)
{
  RepairReport report;
  const auto node_count = static_cast<Index>(mesh.nodes.size());
  const std::size_t merged = mergeNodes(mesh.nodes, mesh.triangles);
  tell(report.done, merged, "nodes at the place of an earlier one merged with it");
  std::vector<char> marked;
  for (const Triangle& triangle : mesh.triangles)
  {
    marked.push_back(hasZeroArea(mesh.nodes, triangle) ? 0 : 1);
  }
  tell(report.done, keep(marked, mesh.triangles, nullptr), "triangles without area dropped");
  tell(report.done, dropRepeated(node_count, mesh.triangles, nullptr),
       "duplicate triangles dropped");
  tell(report.done, orientSurface(mesh), "triangles turned");
  const std::size_t unused = dropUnusedNodes(mesh.nodes, mesh.triangles) - merged;
  tell(report.done, unused, "nodes in no triangle dropped");
  if (mesh.triangles.empty())
  {
    throw Error("repair: no triangle is left");
  }
  tellTopology(surfaceTopology(static_cast<Index>(mesh.nodes.size()), mesh.triangles), "", report);
  return report;
}

}  // namespace soft_tissue
