#include "friction.h"

#include <algorithm>
#include <cmath>

#include "sample_blocks.h"

namespace soft_tissue
{
namespace
{
/** Slip from which on the force is Coulomb's, m. */
constexpr double kStick = 2e-5;

/** How far the second body has slid along the first. */
Vec3 slip(const Grip& grip, const Points& x)
{
  const Vec3 moved = grip.at(x) - grip.stuck_at;
  return moved - grip.normal.dot(moved) * grip.normal;
}

/** How much nearer both have come in the step, m; parting counts nothing. */
double approach(const Grip& grip, const Points& x)
{
  return std::max(0.0, grip.normal.dot(grip.at(x) - grip.stuck_at));
}
}  // namespace

void Friction::begin(const Points& x)
{
  slipped_.clear();
  for (const Grip& grip : grips_)
  {
    const Vec3 by = slip(grip, x) / kStick;
    slipped_.push_back({grip.place, by / std::max(1.0, by.norm())});
  }
  next_slipped_ = 0;
  grips_.clear();
}

void Friction::add(Grip grip)
{
  while (next_slipped_ < slipped_.size() && slipped_[next_slipped_].place < grip.place)
  {
    ++next_slipped_;
  }
  if (next_slipped_ < slipped_.size() && slipped_[next_slipped_].place == grip.place)
  {
    const Vec3& by = slipped_[next_slipped_].by;
    grip.stuck_at -= kStick * (by - grip.normal.dot(by) * grip.normal);
  }
  grips_.push_back(grip);
}

// The slip at a step's end is what its grips say there.
void Friction::addTo(StateHash& hash) const
{
  for (const Grip& grip : grips_)
  {
    hash.addValue(grip.place);
    hash.add(grip.normal.data(), sizeof(Vec3));
    hash.add(grip.stuck_at.data(), sizeof(Vec3));
    hash.add(grip.node.data(), grip.count * sizeof(Index));
    hash.add(grip.weight.data(), grip.count * sizeof(double));
  }
}

void Friction::exchange(StateArchive& archive)
{
  archive.value(step_s_);  // forces of damping are told before the next step begins
  std::uint64_t count = grips_.size();
  archive.value(count);
  if (archive.reading())
  {
    grips_.assign(count, Grip());
    slipped_.clear();
  }
  for (Grip& grip : grips_)
  {
    archive.value(grip.place);
    archive.value(grip.normal);
    archive.value(grip.press);
    archive.value(grip.count);
    archive.value(grip.node);
    archive.value(grip.weight);
    archive.value(grip.stuck_at);
    archive.value(grip.origin);
  }
}

void Friction::forget()
{
  grips_.clear();
  slipped_.clear();
}

/** Of full strength from the stick length on, below it 2 y - y^2 of that, y = slip / stick. */
double Friction::forcePerSlip(const Grip& grip, double slip) const
{
  const double y = slip / kStick;
  return coefficient_ * grip.press / kStick * (y < 1.0 ? 2.0 - y : 1.0 / y);
}

double Friction::forcePerApproach(const Grip& grip) const
{
  return damping_ * grip.press / step_s_;
}

/** What those forces add up to, zero at rest. */
double Friction::value(const Points& x) const
{
  double sum = 0.0;
  for (const Grip& grip : grips_)
  {
    const double y = slip(grip, x).norm() / kStick;
    sum += coefficient_ * grip.press * kStick * (y < 1.0 ? y * y * (1.0 - y / 3.0) : y - 1.0 / 3.0);
    const double nearer = approach(grip, x);
    sum += 0.5 * forcePerApproach(grip) * nearer * nearer;
  }
  return sum;
}

/** On the first body. */
Vec3 Friction::forceOf(const Grip& grip, const Points& x) const
{
  const Vec3 along = slip(grip, x);
  return forcePerSlip(grip, along.norm()) * along +
         forcePerApproach(grip) * approach(grip, x) * grip.normal;
}

void Friction::addGradient(const Points& x, Points& gradient) const
{
  for (const Grip& grip : grips_)
  {
    const Vec3 force = forceOf(grip, x);
    for (int j = 0; j < grip.count; ++j)
    {
      gradient[grip.node[j]] += grip.weight[j] * force;
    }
  }
}

void Friction::addHessian(const Points& x, BlockMatrix& hessian) const
{
  for (const Grip& grip : grips_)
  {
    const Vec3 along = slip(grip, x);
    const double length = along.norm(), y = length / kStick;
    const double scale = coefficient_ * grip.press / kStick;
    const double ratio = forcePerSlip(grip, length);
    const double slope = y < 1.0 ? 2.0 * scale * (1.0 - y) : 0.0;  // of the force by the slip
    const Mat3 plane = Mat3::Identity() - grip.normal * grip.normal.transpose();
    Mat3 block = ratio * plane;
    if (length > 0.0)
    {
      block += (slope - ratio) / (length * length) * along * along.transpose();
    }
    if (approach(grip, x) > 0.0)
    {
      block += forcePerApproach(grip) * grip.normal * grip.normal.transpose();
    }
    addBlocks(grip.count, grip.node, hessian,
              [&](int i, int j) -> Mat3 { return grip.weight[i] * grip.weight[j] * block; });
  }
}

const std::vector<FrictionForce>& Friction::forcesAt(const Points& x)
{
  forces_.clear();
  for (const Grip& grip : grips_)
  {
    forces_.push_back({grip.origin + grip.at(x), grip.normal, forceOf(grip, x)});
  }
  return forces_;
}

}  // namespace soft_tissue
