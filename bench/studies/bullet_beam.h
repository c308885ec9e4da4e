#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/material.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::studies
{
/**
 * A deformable body of the Bullet library (single precision, implicit, no damping), nodes pinned by
 * projection; there only if the study was built with Bullet.
 */
class BulletBeam
{
 public:
  static bool available();

  /**
   * @param fixed       nodes that stay where they are
   * @param neo_hookean stable neo-Hookean with the constants of [Smith2018]; else the library's
   *                    corotated linear law
   * @throws Error without Bullet
   */
  BulletBeam(const TetMesh& rest, const std::vector<Index>& fixed, bool neo_hookean,
             const TetStiffnessParameters& stiffness, double density_kg_per_m3,
             const Vec3& gravity);
  ~BulletBeam();

  void step(double step_s);
  Points positions() const;  ///< N x 3, m

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace soft_tissue::studies
