#include "friction.h"

#include <cmath>

#include "sample_blocks.h"

namespace soft_tissue
{
namespace
{
/** Below this speed of sliding the force is less than Coulomb's, m/s. */
constexpr double kStickSpeed = 1e-4;
}  // namespace

void Friction::lag(const std::vector<ContactSample>& samples, const Points& x,
                   const Pose& X_WT_before, const Pose& X_WT, double step_s)
{
  stick_m_ = kStickSpeed * step_s;
  touches_.clear();
  const Pose motion = X_WT * X_WT_before.inverse();
  for (const ContactSample& sample : samples)
  {
    if (!(sample.stiffness_area > 0.0) || !(sample.force > 0.0))
    {
      continue;
    }
    Touch touch;
    touch.normal = -sample.tool_sign * sample.gradient.normalized();
    touch.strength = coefficient_ * sample.force;
    touch.count = sample.count;
    touch.node = sample.node;
    for (int j = 0; j < sample.count; ++j)
    {
      touch.weight[j] = -sample.tool_sign * sample.coefficient[j];
    }
    touch.carried_to = motion * pointOf(touch, x);
    touches_.push_back(touch);
  }
}

/** Where the tissue's point of contact is. */
Vec3 Friction::pointOf(const Touch& touch, const Points& x)
{
  Vec3 point = Vec3::Zero();
  for (int j = 0; j < touch.count; ++j)
  {
    point += touch.weight[j] * x[touch.node[j]];
  }
  return point;
}

/** How far the tissue has slid along the tool. */
Vec3 Friction::slip(const Touch& touch, const Points& x)
{
  const Vec3 moved = pointOf(touch, x) - touch.carried_to;
  return moved - touch.normal.dot(moved) * touch.normal;
}

/** Of full strength from the stick length on, below it 2 y - y^2 of that, y = slip / stick. */
double Friction::forcePerSlip(const Touch& touch, double slip) const
{
  const double y = slip / stick_m_;
  return touch.strength / stick_m_ * (y < 1.0 ? 2.0 - y : 1.0 / y);
}

/** What that force adds up to, zero at rest. */
double Friction::value(const Points& x) const
{
  double sum = 0.0;
  for (const Touch& touch : touches_)
  {
    const double y = slip(touch, x).norm() / stick_m_;
    sum += touch.strength * stick_m_ * (y < 1.0 ? y * y * (1.0 - y / 3.0) : y - 1.0 / 3.0);
  }
  return sum;
}

void Friction::addGradient(const Points& x, Points& gradient) const
{
  for (const Touch& touch : touches_)
  {
    const Vec3 along = slip(touch, x);
    const double ratio = forcePerSlip(touch, along.norm());
    for (int j = 0; j < touch.count; ++j)
    {
      gradient[touch.node[j]] += touch.weight[j] * ratio * along;
    }
  }
}

void Friction::addHessian(const Points& x, BlockMatrix& hessian) const
{
  for (const Touch& touch : touches_)
  {
    const Vec3 along = slip(touch, x);
    const double length = along.norm(), y = length / stick_m_;
    const double scale = touch.strength / stick_m_;
    const double ratio = forcePerSlip(touch, length);
    const double slope = y < 1.0 ? 2.0 * scale * (1.0 - y) : 0.0;  // of the force by the slip
    const Mat3 plane = Mat3::Identity() - touch.normal * touch.normal.transpose();
    Mat3 block = ratio * plane;
    if (length > 0.0)
    {
      block += (slope - ratio) / (length * length) * along * along.transpose();
    }
    addBlocks(touch.count, touch.node, hessian,
              [&](int i, int j) -> Mat3 { return touch.weight[i] * touch.weight[j] * block; });
  }
}

const std::vector<FrictionForce>& Friction::forcesAt(const Points& x)
{
  forces_.clear();
  for (const Touch& touch : touches_)
  {
    const Vec3 along = slip(touch, x);
    forces_.push_back({pointOf(touch, x), touch.normal, forcePerSlip(touch, along.norm()) * along});
  }
  return forces_;
}

}  // namespace soft_tissue
