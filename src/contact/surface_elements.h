#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_body.h"

namespace soft_tissue
{
/** A point or an edge of a surface, and how much of the surface it stands for. */
struct SurfaceElement
{
  std::array<Index, 2> nodes{};  ///< a point has the same twice
  double area = 0.0;             ///< m^2
  double per_area = 1.0;         ///< what the law counts in place of the area, over the area
  int cells = 1;                 ///< equal parts an edge is cut into for its quadrature
};

/** The nodes that elements have, one after the other: two of an edge, one of a point. */
std::vector<Index> numbersOf(const std::vector<SurfaceElement>& elements, bool edges);

/** Those elements by their numbersOf(), which stay. */
ElementSet elementSet(const std::vector<Index>& numbers, bool edges);

/** The tets of a body. */
ElementSet tetsOf(const TissueBody& body);

/** Adds the nodes that a body's element has its point at a parameter from, with their weights. */
void addNodes(const TissueBody& body, const SurfaceElement& element, double parameter,
              ContactSample& sample);

/**
 * What a law counts in place of an element's area, over that area: 1 for pressure; for the others
 * 1 or the edge's length.
 * @param share  of the area that counts in each direction: by those laws each counts whole
 */
double perArea(ContactLaw law, const SurfaceElement& element, double length, double share);

/** Parts no longer than `cell`, m; one where that is zero. */
int cellsOf(double length, double cell);

/** The elements of a tissue's surface: its nodes, or its edges. */
class SurfaceElements
{
 public:
  /** @param share  see perArea() */
  SurfaceElements(const BoundarySurface& surface, const ContactOptions& options, double share);

  std::size_t size() const { return elements_.size(); }
  const std::vector<SurfaceElement>& all() const { return elements_; }

  /** Node of a point, or the nodes of an edge. */
  const std::array<Index, 2>& nodes(Index element) const { return elements_[element].nodes; }

  /** Takes area and cells of one element from positions x of the body, m. */
  void lag(Index element, const Points& x, double cell);

 private:
  const BoundarySurface* surface_;
  ContactLaw law_;
  double share_;
  std::vector<SurfaceElement> elements_;
  Adjacency triangles_;  ///< rows: elements
};

}  // namespace soft_tissue
