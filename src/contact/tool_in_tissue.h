#pragma once

#include <vector>

#include "soft_tissue_sim/collision/box_grid.h"
#include "soft_tissue_sim/contact/tool_surface.h"
#include "surface_in_tissue.h"

namespace soft_tissue
{
/** Samples of a tool's surface in a tissue. */
class ToolInTissue
{
 public:
  ToolInTissue(const TissueBody& tissue, const RigidBodyShape& tool, const ContactOptions& options);

  void setStiffness(double pa_per_m) { surface_.setStiffness(pa_per_m); }

  /** Puts the tool at a pose. */
  void place(const Pose& X_WT);

  /**
   * Finds the tets that hold points or parts of edges.
   * @param x     positions of the body alone, m
   * @param tets  tets to look in, ascending
   * @return whether there are any
   */
  bool findHosts(const Points& x, const std::vector<Index>& tets);

  /** Appends the samples of what findHosts() found. */
  void addSamples(const DistanceField& field, std::vector<ContactSample>& samples)
  {
    surface_.addSamples(field, samples);
  }

  void exchange(StateArchive& archive) { surface_.exchange(archive); }

  /** Of one of those samples. */
  DepthCurvature curvature(const ContactSample& sample) const { return surface_.curvature(sample); }

 private:
  TissueBody tissue_;
  Points nodes_T_;
  std::vector<SurfaceElement> elements_;
  std::vector<Index> element_nodes_;
  ElementSet numbers_;  ///< of nodes, of elements
  Points nodes_W_;
  std::vector<Box3> boxes_W_;  ///< of elements
  BoxGrid grid_;
  std::vector<ElementPair> candidates_;
  SurfaceInTissue surface_;
};

}  // namespace soft_tissue
