#include "soft_tissue_sim/contact/sample_sums.h"

#include "sample_blocks.h"

namespace soft_tissue
{
double contactEnergy(const std::vector<ContactSample>& samples)
{
  double energy = 0.0;
  for (const ContactSample& s : samples)
  {
    energy += 0.5 * s.stiffness_area * s.excess() * s.excess();
  }
  return energy;
}

void addContactGradient(const std::vector<ContactSample>& samples, Points& gradient)
{
  for (const ContactSample& s : samples)
  {
    const Vec3 push = s.force * s.gradient;
    for (int j = 0; j < s.count; ++j)
    {
      gradient[s.node[j]] += s.coefficient[j] * push;
    }
  }
}

void addLinearStiffness(const ContactSample& s, BlockMatrix& hessian)
{
  const Mat3 gg = s.gradient * s.gradient.transpose();
  addBlocks(s.count, s.node, hessian, [&](int i, int j) -> Mat3 {
    return s.stiffness_area * s.coefficient[i] * s.coefficient[j] * gg;
  });
}

void addStiffness(const ContactSample& s, const DepthCurvature& curvature, BlockMatrix& hessian)
{
  const Vec3& g = s.gradient;
  const auto& c = s.coefficient;
  const auto& b = curvature.turn;
  const Mat3 gg = g * g.transpose();
  const double share = s.excess() / s.depth;
  const Mat3 slide = gg + share * curvature.bend;
  const double turned = curvature.distance ? s.depth * s.excess() : 0.0;
  addBlocks(s.count, s.node, hessian, [&](int i, int j) -> Mat3 {
    return s.stiffness_area *
           (c[i] * c[j] * slide - turned * b[i].dot(b[j]) * gg -
            s.excess() * (c[i] * b[j] * g.transpose() + c[j] * g * b[i].transpose()));
  });
}

}  // namespace soft_tissue
