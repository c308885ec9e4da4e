#pragma once

#include <optional>
#include <vector>

#include "near_boundaries.h"
#include "soft_tissue_sim/collision/clip_pairs.h"
#include "soft_tissue_sim/collision/segment_cover.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_depth.h"
#include "surface_elements.h"

namespace soft_tissue
{
/** Whose surface intrudes into a tissue. */
struct Intruder
{
  int side = 1;        ///< ContactSample::side of its samples
  double share = 0.5;  ///< of its area that counts: half where the other direction does too
  std::optional<TissueBody> body;  ///< none: it is rigid
  /** Its nodes at rest where it is the host itself, m: its own surface is near everywhere, and only
   * what is nearer to the host's point at rest is what it went through. Null for another body. */
  const Points* rest = nullptr;
};

/** Samples of a surface in a tissue's depth: its points, or its edges clipped against the tets. */
class SurfaceInTissue
{
 public:
  SurfaceInTissue(const TissueBody& host, const Intruder& intruder, const ContactOptions& options);

  void setStiffness(double pa_per_m) { stiffness_ = pa_per_m; }
  void setAllowance(double depth_m) { allowance_ = depth_m; }

  /**
   * Finds the tets that hold points or parts of edges.
   * @param elements    of the surface; they and their nodes stay until samples are taken
   * @param numbers     of their nodes, see numbersOf()
   * @param nodes       what elements number, m, world
   * @param x           positions of the host alone, m
   * @param candidates  elements and tets that may meet, ascending by tet
   * @return whether there are any
   */
  bool findHosts(const std::vector<SurfaceElement>& elements, const ElementSet& numbers,
                 const Points& nodes, const Points& x, const std::vector<ElementPair>& candidates);

  /** Appends the samples of what findHosts() found. */
  void addSamples(const DistanceField& field, std::vector<ContactSample>& samples);

  /** Writes, or reads, what later samples depend on beside what a step begins with. */
  void exchange(StateArchive& archive) { depth_.exchange(archive); }

  /** Of one of those samples. */
  DepthCurvature curvature(const ContactSample& sample) const
  {
    return depth_.curvature(sample, *x_);
  }

 private:
  /** A tet, a point of an element in it, and the area it stands for. */
  struct Place
  {
    Index element;
    double parameter;
    Index host;
    double area;
    int number;  ///< of the point on its element, the same when it is sampled again
  };

  void addPoint(Index element, const DistanceField& field, std::vector<ContactSample>& samples);
  void addPieces(Index edge, const DistanceField& field, std::vector<ContactSample>& samples);
  void addStretches(Index edge, const DistanceField& field, std::vector<ContactSample>& samples);
  bool measure(const Place& place, const DistanceField& field, ContactSample& sample);
  Vec3 restPoint(const Place& place) const;
  Vec3 edgeVector(Index edge) const;
  const Vec3& end(Index element, int k) const { return (*nodes_)[(*elements_)[element].nodes[k]]; }

  TissueBody host_;
  Intruder intruder_;
  bool segments_, closest_feature_;
  double stiffness_, allowance_ = 0.0;
  TissueDepth depth_;
  const std::vector<SurfaceElement>* elements_ = nullptr;
  const Points* nodes_ = nullptr;
  const Points* x_ = nullptr;
  std::vector<ClippedPair> clipped_;  ///< what tets hold
  std::vector<Index> point_host_;     ///< per point: a tet, or -1
  std::vector<Index> held_;           ///< points and edges that have a host, ascending
  SegmentCover edge_hosts_;           ///< per edge: its pieces in tets
  NearBoundaries near_;               ///< per sample
  Index hint_ = -1;  ///< boundary triangle nearest to the last sample of the element
};

}  // namespace soft_tissue
