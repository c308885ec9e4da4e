#include "soft_tissue_sim/contact/sample_sums.h"

#include <Eigen/Geometry>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
void addScaledBlock(BlockMatrix& hessian, Index row, Index column, double scale, const Mat3& gg)
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
    block[i] += scale * gg.data()[i];  // gg is symmetric: either storage order
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

void addContactHessian(const std::vector<ContactSample>& samples, BlockMatrix& hessian)
{
  for (const ContactSample& s : samples)
  {
    if (s.stiffness_area == 0.0)
    {
      continue;
    }
    const Mat3 gg = s.stiffness_area * s.gradient * s.gradient.transpose();
    for (int i = 0; i < s.count; ++i)
    {
      for (int j = 0; j < s.count; ++j)
      {
        const double scale = s.coefficient[i] * s.coefficient[j];
        if (scale != 0.0 && s.node[i] <= s.node[j])
        {
          addScaledBlock(hessian, s.node[i], s.node[j], scale, gg);
        }
      }
    }
  }
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
