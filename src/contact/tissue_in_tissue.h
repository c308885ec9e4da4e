#pragma once

#include <memory>
#include <vector>

#include "host_field.h"
#include "soft_tissue_sim/collision/pair_finder.h"
#include "surface_in_tissue.h"

namespace soft_tissue
{
/** Samples of the surface of a tissue or a membrane in another tissue, or in itself. */
class TissueInTissue
{
 public:
  /**
   * @param side  ContactSample::side of its samples
   * @param self  both are the same body
   */
  TissueInTissue(const TissueBody& intruder, const TissueBody& host,
                 std::unique_ptr<DistanceField> host_field, int side, bool self,
                 const ContactOptions& options);

  void setStiffness(double pa_per_m) { surface_.setStiffness(pa_per_m); }
  void setAllowance(double depth_m) { surface_.setAllowance(depth_m); }
  HostField& field() { return field_; }

  /** Of each body alone, m. */
  struct Positions
  {
    const Points* intruder = nullptr;
    const Points* host = nullptr;
  };

  /** Takes areas, and the positions that depths are marched on. @param start  they stay */
  void beginStep(const Positions& start, bool refresh);
  /**
   * Looks for candidates; the step has begun.
   * @param margin  how much both may move in all until they are too few, m
   */
  void lookAround(const Positions& at, double margin);

  bool hasCandidates() const { return !candidates_.empty(); }

  /** Finds what is inside, at positions of each body alone, m; they stay until samples are taken.
   * @return whether anything is */
  bool find(const Points& intruder, const Points& host);
  /** Appends the samples of what was found. */
  void addSamples(std::vector<ContactSample>& samples)
  {
    surface_.addSamples(field_.ready(), samples);
  }

  /** Writes, or reads into one that has just begun the same step, what it has found. */
  void exchange(StateArchive& archive)
  {
    field_.exchange(archive);
    surface_.exchange(archive);
  }

  /** Of one of those samples. */
  DepthCurvature curvature(const ContactSample& sample) const { return surface_.curvature(sample); }

 private:
  void lagElements();

  TissueBody host_;
  SurfaceElements elements_;
  std::vector<Index> element_nodes_;
  ElementSet numbers_;  ///< of nodes, of the surface's elements
  std::unique_ptr<PairFinder> finder_;
  HostField field_;
  SurfaceInTissue surface_;
  Positions start_;
  std::vector<ElementPair> candidates_;
  std::vector<Index> near_elements_;  ///< of candidates
  std::vector<Index> host_nodes_;     ///< of candidate tets
  std::vector<char> seen_;            ///< per element, and then per host node
};

}  // namespace soft_tissue
