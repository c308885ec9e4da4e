#include "soft_tissue_sim/contact/sample_sums.h"

#include <Eigen/Geometry>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
void addBlock(BlockMatrix& hessian, Index row, Index column, const Mat3& b)
{
  const Index position = hessian.find(row, column);
  if (position < 0)
  {
    throw Error("contact couples nodes " + std::to_string(row) + " and " + std::to_string(column) +
                ", which share no element of the matrix's pattern");
  }
  double* block = hessian.block(position);
  for (int i = 0; i < 9; ++i)
  {
    block[i] += b.data()[i];
  }
}

/** hessian += kappa area block(i, j) for the pairs of the sample's nodes; the block is symmetric in
 * that (j, i) has its transpose. */
template <typename Block>
void addPairs(const ContactSample& s, BlockMatrix& hessian, const Block& block)
{
  for (int i = 0; i < s.count; ++i)
  {
    for (int j = 0; j < s.count; ++j)
    {
      if (s.node[i] <= s.node[j])
      {
        addBlock(hessian, s.node[i], s.node[j], s.stiffness_area * block(i, j));
      }
    }
  }
}
}  // namespace

double contactEnergy(const std::vector<ContactSample>& samples)
{
  double energy = 0.0;
  for (const ContactSample& s : samples)
  {
    energy += 0.5 * s.stiffness_area * s.depth * s.depth;
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
  addPairs(s, hessian,
           [&](int i, int j) -> Mat3 { return s.coefficient[i] * s.coefficient[j] * gg; });
}

void addStiffness(const ContactSample& s, const DepthCurvature& curvature, BlockMatrix& hessian)
{
  const Vec3& g = s.gradient;
  const auto& c = s.coefficient;
  const auto& b = curvature.turn;
  const Mat3 gg = g * g.transpose();
  const Mat3 slide = gg + curvature.bend;
  const double turned = curvature.distance ? s.depth * s.depth : 0.0;
  addPairs(s, hessian, [&](int i, int j) -> Mat3 {
    return c[i] * c[j] * slide - turned * b[i].dot(b[j]) * gg -
           s.depth * (c[i] * b[j] * g.transpose() + c[j] * g * b[i].transpose());
  });
}

void addToolWrench(const std::vector<ContactSample>& samples, const Vec3& reference, Vec3& force,
                   Vec3& torque)
{
  for (const ContactSample& s : samples)
  {
    const Vec3 on_tool = s.forceOnTool();
    force += on_tool;
    torque += (s.position - reference).cross(on_tool);
  }
}

}  // namespace soft_tissue
