#pragma once

#include <cstdint>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** The elements of a tet body whose boxes overlap a given one, each list ascending. */
class BoxSelection
{
 public:
  /** Selects anew; x: N x 3, m, for the nodes that tets and surface name. Linear in the body's
   * size. */
  void select(const Points& x, const std::vector<Tet>& tets, const BoundarySurface& surface,
              const Box3& box);
  void clear();

  bool empty() const { return tets_.empty() && surface_edges_.empty(); }
  const std::vector<Index>& tets() const { return tets_; }
  const std::vector<Index>& tetNodes() const { return tet_nodes_; }  ///< all nodes of those tets
  const std::vector<Index>& surfaceNodes() const
  {
    return surface_nodes_;
  }  ///< boundary nodes in the box
  const std::vector<Index>& surfaceEdges() const { return surface_edges_; }

 private:
  std::vector<std::uint8_t> outside_;  ///< per node, a bit for each side of the box it is beyond
  std::vector<std::uint8_t> wanted_;   ///< per node, whether a selected tet has it
  std::vector<Index> tets_, tet_nodes_, surface_nodes_, surface_edges_;
};

}  // namespace soft_tissue
