#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue::studies
{
/** Whether this was built with Bullet. */
bool haveBullet();

/** The tets of two bodies in Bullet's dynamic trees of boxes (btDbvt). */
class BulletTets
{
 public:
  BulletTets(const std::vector<Tet>& a, const Points& x_a, const std::vector<Tet>& b,
             const Points& x_b);
  ~BulletTets();

  /** Gives every tet its new box and lists the pairs whose boxes overlap, in any order. */
  void find(const Points& x_a, const Points& x_b, std::vector<ElementPair>& pairs);

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace soft_tissue::studies
