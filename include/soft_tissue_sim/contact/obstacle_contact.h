#pragma once

#include <memory>

#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/geometry/voxel_shape.h"

namespace soft_tissue
{
/**
 * Contact of one obstacle that stands still, the first of the pair, with one tissue: the tissue's
 * surface in the obstacle's distance, all of it.
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

 private:
  void collect(std::vector<ContactSample>& samples) override;
  DepthCurvature curvature(const ContactSample& sample) const override;
  void setStiffness(double pa_per_m) override;
  void forgetField() override {}
  void lagFriction(const Points& x);
  void lagPlaces(const Points& x);
  void select();

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace soft_tissue
