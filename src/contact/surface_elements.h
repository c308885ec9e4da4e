#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/tissue_body.h"

namespace soft_tissue
{
/** A point or an edge of a surface, and how much of the surface it stands for. */
struct SurfaceElement
{
  std::array<Index, 2> nodes{};  ///< a point has the same twice
  double area = 0.0;             ///< m^2
  int cells = 1;                 ///< equal parts an edge is cut into for its quadrature
};

/** Adds the nodes that a body's element has its point at a parameter from, with their weights. */
void addNodes(const TissueBody& body, const SurfaceElement& element, double parameter,
              ContactSample& sample);

/** Parts no longer than `cell`, m; one where that is zero. */
int cellsOf(double length, double cell);

/** The elements of a tissue's surface: its nodes, or its edges. */
class SurfaceElements
{
 public:
  SurfaceElements(const BoundarySurface& surface, bool edges);

  std::size_t size() const { return elements_.size(); }
  const std::vector<SurfaceElement>& all() const { return elements_; }

  /** Node of a point, or the nodes of an edge. */
  const std::array<Index, 2>& nodes(Index element) const { return elements_[element].nodes; }

  /** Takes area and cells of one element from positions x of the body, m. */
  void lag(Index element, const Points& x, double cell);

 private:
  const BoundarySurface* surface_;
  std::vector<SurfaceElement> elements_;
  Adjacency triangles_;  ///< rows: elements
};

}  // namespace soft_tissue
