#pragma once

#include <memory>

#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/geometry/voxel_shape.h"

namespace soft_tissue
{
/**
 * Contact of one obstacle, the first of the pair, with one tissue: the tissue's surface in the
 * obstacle's distance, all of it. Within a step the obstacle stands still.
 *
 * The obstacle's own surface is not sampled in the tissue: its cells are to be no finer than the
 * tissue's edges. beginStep() lags what the minimisation holds fixed: candidate elements, their
 * areas, and where and how hard friction acts. It covers the obstacle where the tissue can get.
 */
class ObstacleContact : public ContactTerm
{
 public:
  /** @param X_WO  pose of the obstacle in the world */
  ObstacleContact(const TissueBody& tissue, std::shared_ptr<VoxelShape> obstacle, const Pose& X_WO,
                  const ContactOptions& options);
  ~ObstacleContact() override;

  /**
   * Takes the state a step starts from.
   * @param x       positions at the start of the step
   */
  void beginStep(const Points& x);

  bool active() const override;
  void addTo(StateHash& hash) const override;

  /**
   * The obstacle is about to change, in cells or pose: what the tissue presses with is noted.
   * @param x      positions of the nodes
   * @param box_W  where it changes, world, m
   */
  void beforeChange(const Points& x, const Box3& box_W);
  /**
   * It has changed. What got into it by that, or deeper, is allowed there: it presses no harder
   * than before.
   * @param X_WO  pose of the obstacle in the world from now on
   */
  void afterChange(const Points& x, const Pose& X_WO);

  /** Puts the obstacle elsewhere. */
  void setPose(const Pose& X_WO);

  /** Allows all that is in the obstacle at x to be there, and nothing else. */
  void allowAll(const Points& x);
  /** Takes so much of what is allowed, m: it pushes the tissue out as slowly as one likes.
   * @return the most that is allowed still */
  double easeAllowances(double by);
  /** Depths that press nothing, m, of the elements contact is integrated over; empty: none. */
  const std::vector<double>& allowances() const;
  void setAllowances(const std::vector<double>& depths_m);

 private:
  void collect(std::vector<ContactSample>& samples) override;
  DepthCurvature curvature(const ContactSample& sample) const override;
  void setStiffness(double pa_per_m) override;
  void exchangePlaces(StateArchive& archive) override;
  void forgetPlaces() override {}
  void lagFriction(const Points& x);
  void lagPlaces(const Points& x);
  void select();

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace soft_tissue
