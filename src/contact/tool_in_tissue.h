#pragma once

#include <vector>

#include "soft_tissue_sim/collision/box_grid.h"
#include "soft_tissue_sim/collision/segment_cover.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/tissue_depth.h"
#include "soft_tissue_sim/contact/tool_contact.h"
#include "soft_tissue_sim/contact/tool_surface.h"

namespace soft_tissue
{
/** Samples of a tool's surface in a tissue: its points, or its edges clipped against the tets. */
class ToolInTissue
{
 public:
  ToolInTissue(const TissueBody& tissue, const RigidBodyShape& tool,
               const ToolContactOptions& options);

  void setStiffness(double pa_per_m) { options_.stiffness_pa_per_m = pa_per_m; }

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
  void addSamples(const Points& x, const DistanceField& field, std::vector<ContactSample>& samples);

  /** Of one of those samples; x as they were taken at. */
  DepthCurvature curvature(const ContactSample& sample, const Points& x) const
  {
    return depth_.curvature(sample, x);
  }

 private:
  struct Host
  {
    Index tet;
    TetCoordinates coords;
  };

  void hostPoints(const Host& host, Index number, const Box3& box);
  void hostEdges(const Host& host, Index number, const Box3& box);
  void addPieces(Index edge, const Points& x, const DistanceField& field,
                 std::vector<ContactSample>& samples);
  void addStretches(Index edge, const Points& x, const DistanceField& field,
                    std::vector<ContactSample>& samples);
  template <typename SampleAt>
  void addStretch(Index edge, const Interval& stretch, bool begin_moves, bool end_moves,
                  const SampleAt& sampleAt, std::vector<ContactSample>& samples) const;
  int cellsOf(Index edge) const;
  bool measure(const Vec3& p, const Host& host, double area, const Points& x,
               const DistanceField& field, ContactSample& sample) const;
  Vec3 edgePoint(Index edge, double parameter) const;

  TissueBody tissue_;
  ToolContactOptions options_;
  ToolSurface surface_;
  TissueDepth depth_;
  Points nodes_W_;
  std::vector<Box3> boxes_W_;  ///< of points or edges, as the response has it
  BoxGrid grid_;
  std::vector<Host> hosts_;        ///< tets that hold something
  std::vector<Index> point_host_;  ///< per tool node: place in hosts_, or -1
  SegmentCover edge_hosts_;        ///< per tool edge: its pieces in hosts_
  bool found_ = false;
};

}  // namespace soft_tissue
