#pragma once

#include <string>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/**
 * One number of a scene, by name: `liver/young_modulus_pa`, `liver/3/young_modulus_pa` of the
 * region with tag 3, `liver/probe/stiffness_pa_per_m` of the contact between the two.
 *
 * Of a tissue, a membrane or a region: young_modulus_pa, poisson_ratio, stiffening; of a contact:
 * stiffness_pa_per_m, friction.
 */
class SceneParameter
{
 public:
  /** @throws Error naming what the scene has, if there is no such number or the scene leaves it
   * open
   */
  SceneParameter(const SceneConfig& scene, const std::string& name);

  const std::string& name() const { return name_; }

  /** In the unit that its name ends with. */
  double value(const SceneConfig& scene) const;
  void set(SceneConfig& scene, double value) const;

  /** What is positive without bound varies in proportion: its fits are of the logarithm. */
  bool isLogarithmic() const { return upper_ <= 0.0; }
  /** Of one that isn't logarithmic. */
  double lower() const { return lower_; }
  double upper() const { return upper_; }

 private:
  double* find(SceneConfig& scene) const;

  std::string name_, body_, part_, key_;
  double lower_ = 0.0, upper_ = 0.0;
};

}  // namespace soft_tissue
