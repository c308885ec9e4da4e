#pragma once

#include <vector>

#include "soft_tissue_sim/collision/box_selection.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "soft_tissue_sim/contact/tool_contact.h"
#include "surface_elements.h"

namespace soft_tissue
{
/** Samples of a tissue's surface in a tool's exact distance: its points, or its edges. */
class TissueInTool
{
 public:
  /** @param share  of the surface's area that counts: half where the other direction does too */
  TissueInTool(const TissueBody& tissue, const RigidBodyShape& tool, const ContactOptions& options,
               double share = 0.5);

  void setStiffness(double pa_per_m) { options_.stiffness_pa_per_m = pa_per_m; }

  /** Puts the tool at a pose. */
  void place(const Pose& X_WT);

  /** Bounds of the tool where it was placed, world. */
  const Box3& bounds() const { return bounds_W_; }

  /** Takes areas and the number of quadrature cells for these elements from x (the body's, m). */
  void lagAreas(const Points& x, const BoxSelection& elements);

  /** Of those elements, leaves out what stays outside while no node moves farther than this, m. */
  void dropFarther(const Points& x, double margin);

  std::size_t elementCount() const { return surface_.size(); }

  /** Whether any element is left that may touch. */
  bool any() const { return !near_.empty(); }

  /** Appends the samples of those elements at x, positions of the body alone, m. */
  void addSamples(const Points& x, std::vector<ContactSample>& samples) const;

  /** How deep each element is in the tool at x at its deepest, less what it is allowed: what of it
   * presses, m, <= 0 outside; elements that a box does not overlap have -infinity. */
  void findExcess(const Points& x, const Box3& box_W, std::vector<double>& excess) const;
  /**
   * Has elements in a box press no harder than they did, however deep they are now: they are
   * allowed the difference.
   * @param excess  of findExcess(), before the tool became another
   */
  void allowMore(const Points& x, const Box3& box_W, const std::vector<double>& excess);
  /** What elements are allowed, m; empty: nothing. */
  const std::vector<double>& allowances() const { return allowed_; }
  void setAllowances(const std::vector<double>& allowed) { allowed_ = allowed; }
  /** Takes so much of every allowance, m. @return the largest there is */
  double easeAllowances(double by);

  /** Of one of those samples. */
  DepthCurvature curvature(const ContactSample& sample) const;

 private:
  void addPoint(Index point, const Points& x, std::vector<ContactSample>& samples) const;
  void addEdge(Index edge, const Points& x, std::vector<ContactSample>& samples) const;
  double allowedTo(Index element) const;
  /** @param weight  of the element's area */
  bool measure(const Vec3& p, Index element, double parameter, double weight,
               ContactSample& sample) const;
  NearestHint& hintAt(Index element, double parameter) const;

  TissueBody tissue_;
  const RigidBodyShape& tool_;
  ContactOptions options_;
  double share_;
  double cell_length_;
  Pose X_WT_ = Pose::Identity();
  Pose X_TW_ = Pose::Identity();
  Box3 bounds_W_;
  SurfaceElements surface_;
  std::vector<Index> near_;      ///< elements of it that may touch
  std::vector<double> allowed_;  ///< per element, depth that presses nothing, m; empty: none
  std::vector<double> deepest_;  ///< of allowMore()
  /** Per element, of places along it: what was near there last. None for most. */
  mutable std::vector<std::vector<NearestHint>> hints_;
  mutable NearestHint elsewhere_;  ///< of elements that have none of their own
};

}  // namespace soft_tissue
