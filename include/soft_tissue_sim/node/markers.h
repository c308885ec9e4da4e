#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "soft_tissue_sim/node/message_builders.h"
#include "soft_tissue_sim/node/tissue_depths.h"
#include "soft_tissue_sim/node/tool_looks.h"

namespace soft_tissue_sim
{
/** How markers look. */
struct MarkerOptions
{
  enum class ColourBy
  {
    displacement,
    stress,
  };
  ColourBy colour_by = ColourBy::displacement;
  double colour_max = 0.0;      ///< m or Pa at the end of the colour scale; 0: the largest at hand
  int slice_axis = 1;           ///< normal of the slice through the distance field: 0 x, 1 y, 2 z
  double slice_fraction = 0.5;  ///< where between the rest shape's bounds the slice lies
  double force_scale_m_per_n = 0.02;  ///< length of the arrow of a tool's whole force
};

/**
 * Markers of a scene; ns and id of each stay the same from one array to the next.
 *
 * Namespaces: `<tissue>`, `<tissue>/fixed`, `<tissue>/distance/slice`, `<tissue>/distance/nodes`,
 * `<tool>` (a marker for each of toolLooks()), `<tool>/contacts` (the strongest ones),
 * `<tool>/force`, `tissue_pairs` (the strongest contacts of each pair, which no tissue or tool may
 * be called).
 */
class MarkerBuilder
{
 public:
  MarkerBuilder(const SceneInfo& info, const MarkerOptions& options);

  visualization_msgs::MarkerArray build(const soft_tissue::Snapshot& snapshot, TissueDepths& depths,
                                        const Stamp& stamp) const;

  /** Removes all markers shown so far; the first of an array, if in one. */
  static visualization_msgs::Marker deleteAll(const Stamp& stamp);

 private:
  const SceneInfo& info_;
  MarkerOptions options_;
  std::vector<double> slice_offset_m_;        ///< per tissue
  std::vector<std::vector<ToolLook>> tools_;  ///< of each tool
};

/** Most contact arrows a tool, or a pair of tissues, gets. */
constexpr std::size_t kMaxContactArrows = 50;

}  // namespace soft_tissue_sim
