#pragma once

#include <cstdint>
#include <optional>

#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/geometry/barycentric.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"

namespace soft_tissue
{
/** What is known of the boundary near a point: it spares searches, and changes no answer. */
struct NearBoundary
{
  Index hint = -1;            ///< a triangle that may be near
  Shortlist list;             ///< of what was near when the point was searched for
  Vec3 place = Vec3::Zero();  ///< of the point then, m
  double travelled = 0.0;     ///< TissueDepth::Travel then
  std::uint32_t travel = 0;
  /** In self-contact, at rest: the point, and the place in the tet that it had come to, m. */
  Vec3 rest_point = Vec3::Zero(), rest_place = Vec3::Zero();
};

/**
 * Depth of points inside a deformed tissue, with what it depends on.
 *
 * The nearest boundary feature is the global one: that of the host's nearest node gives a bound, a
 * tree over the boundary searches below it. A local minimum would make the energy jump from tet to
 * tet. The tree serves while nodes have not moved far, and what it found near a point while that
 * and they have not.
 */
class TissueDepth
{
 public:
  /**
   * @param closest_feature  true distance to the nearest boundary feature; false: linear in the tet
   *                         from nodal depths that are held constant
   */
  TissueDepth(const TissueBody& tissue, bool closest_feature);

  /** Takes the positions of the body alone, m, that the next evaluations are at; the first ones
   * finite. */
  void prepare(const Points& x);

  /** Writes, or reads, what of earlier positions later answers depend on. */
  void exchange(StateArchive& archive);

  /**
   * Sets position, depth, gradient, nodes and coefficients of a sample at p.
   * @param p       point in `tet`, m, world
   * @param x       positions of the body alone, N x 3, m, as last prepared
   * @param field   marched on all nodes of `tet`
   * @param near    of this point, if it was evaluated before; its hint becomes the nearest triangle
   * @return false where no part of the boundary is at a finite distance, or `tet` is flat and its
   *         shape is asked for
   */
  bool evaluate(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                NearBoundary& near, ContactSample& sample) const;

  /**
   * The same at a point of the tissue's own surface that has come to be inside it.
   * @param rest     the body's nodes at rest, N x 3, m
   * @param rest_of  the point itself at rest, m: only boundary that is there no farther from the
   *                 place in the tet than from this is what the point may have come through
   */
  bool evaluateSelf(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                    const Points& rest, const Vec3& rest_of, NearBoundary& near,
                    ContactSample& sample) const;

  /** What the second derivative of a sample's depth needs; x as it was evaluated at. */
  DepthCurvature curvature(const ContactSample& sample, const Points& x) const;

 private:
  std::optional<TetCoordinates> coordinates(Index tet, const Points& x) const;
  bool interpolate(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                   ContactSample& sample) const;
  template <typename Allowed>
  TriangleTree::Nearest onOwnTriangle(const Vec3& p, Index tet, const Points& x,
                                      const Allowed& allowed) const;
  template <typename Allowed>
  TriangleTree::Nearest listed(const Vec3& p, const Points& x, const NearBoundary& near,
                               const Allowed& allowed) const;
  void remember(const Vec3& p, NearBoundary& near) const;
  Index hintFor(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                Index hint) const;
  bool takeFeature(const Vec3& p, const TriangleTree::Nearest& found, const Points& x,
                   ContactSample& sample) const;
  /** How far the boundary's nodes have come, each by no more than so much beside a common shift. */
  struct Travel
  {
    std::uint32_t number = 1;  ///< they are counted anew from time to time
    Vec3 shift = Vec3::Zero();
    double most = 0.0;
    Points nodes;  ///< where they were last
  };

  void travelTo(const Points& x);

  TissueBody tissue_;
  bool closest_feature_;
  Adjacency tet_triangles_;  ///< rows: tets; boundary triangles of each
  TriangleTree tree_;        ///< over the boundary where it was at tree_nodes_
  Points tree_nodes_;        ///< by place in BoundarySurface::nodes, m
  Points built_nodes_;       ///< the same where it was built
  NodeMotion motion_;        ///< of boundary nodes since tree_nodes_
  Travel travel_;
  Points now_;  ///< to be Travel::nodes
};

}  // namespace soft_tissue
