#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue::studies
{
/** Whether this was built with FCL. */
bool haveFcl();

/** Two surfaces in FCL's trees of axis-aligned boxes. */
class FclSurfaces
{
 public:
  FclSurfaces(const std::vector<Triangle>& a, const Points& x_a, const std::vector<Triangle>& b,
              const Points& x_b);
  ~FclSurfaces();

  /**
   * Refits both trees, bottom up, and counts all pairs of triangles that intersect.
   * @param inside  by the traversal that fcl::collide() calls after copying both models
   */
  std::size_t collide(const Points& x_a, const Points& x_b, bool inside);

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace soft_tissue::studies
