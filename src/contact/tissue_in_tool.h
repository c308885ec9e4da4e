#pragma once

#include <vector>

#include "soft_tissue_sim/collision/box_selection.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "soft_tissue_sim/contact/tool_contact.h"

namespace soft_tissue
{
/** Samples of a tissue's surface in a tool's exact distance: its points, or its edges. */
class TissueInTool
{
 public:
  TissueInTool(const TissueBody& tissue, const RigidBodyShape& tool,
               const ToolContactOptions& options);

  void setStiffness(double pa_per_m) { options_.stiffness_pa_per_m = pa_per_m; }

  /** Puts the tool at a pose. */
  void place(const Pose& X_WT);

  /** Bounds of the tool where it was placed, world. */
  const Box3& bounds() const { return bounds_W_; }

  /** Takes areas and the number of quadrature cells for these elements from x (the body's, m). */
  void lagAreas(const Points& x, const BoxSelection& elements);

  /** Appends the samples of those elements at x, positions of the body alone, m. */
  void addSamples(const Points& x, std::vector<ContactSample>& samples) const;

  /** Of one of those samples. */
  DepthCurvature curvature(const ContactSample& sample) const;

 private:
  struct Element
  {
    Index number;  ///< surface node or place in surface->edges
    double area;   ///< m^2
    int cells;     ///< of an edge
  };

  void addPoint(const Element& node, const Points& x, std::vector<ContactSample>& samples) const;
  void addEdge(const Element& edge, const Points& x, std::vector<ContactSample>& samples) const;
  bool measure(const Vec3& p, double area, ContactSample& sample) const;

  TissueBody tissue_;
  const RigidBodyShape& tool_;
  ToolContactOptions options_;
  double cell_length_;
  Adjacency edge_triangles_;  ///< rows: surface edges
  Pose X_WT_ = Pose::Identity();
  Pose X_TW_ = Pose::Identity();
  Box3 bounds_W_;
  std::vector<Element> elements_;
};

}  // namespace soft_tissue
