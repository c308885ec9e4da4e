#include "soft_tissue_sim/energy/anchor_springs.h"

namespace soft_tissue
{
double AnchorSprings::value(const Points& x)
{
  double sum = 0.0;
  for (const AnchorSpring& spring : springs_)
  {
    sum += 0.5 * spring.stiffness * (x[spring.node] - spring.place).squaredNorm();
  }
  return sum;
}

void AnchorSprings::addGradient(const Points& x, Points& gradient)
{
  for (const AnchorSpring& spring : springs_)
  {
    gradient[spring.node] += spring.force(x);
  }
}

void AnchorSprings::addHessian(const Points& /*x*/, Curvature /*curvature*/, BlockMatrix& hessian)
{
  for (const AnchorSpring& spring : springs_)
  {
    hessian.add(spring.node, spring.node, spring.stiffness * Mat3::Identity());
  }
}

}  // namespace soft_tissue
