#pragma once

#include "friction.h"

namespace soft_tissue
{
/** The tissue's point at a sample, that the tool takes along where it sticks. */
inline Grip gripOf(const ContactSample& sample, const Points& x, const Pose& motion)
{
  Grip grip;
  grip.normal = sample.normal();
  grip.press = sample.force;
  grip.count = sample.count;
  grip.node = sample.node;
  for (int j = 0; j < sample.count; ++j)
  {
    grip.weight[j] = -sample.side * sample.coefficient[j];
  }
  grip.stuck_at = motion * grip.at(x);
  grip.origin = Vec3::Zero();
  return grip;
}

/** Adds the grips of all samples that press. */
inline void addGrips(const std::vector<ContactSample>& samples, const Points& x, const Pose& motion,
                     Friction& friction)
{
  forEachPress(samples, [&](const ContactSample& sample, std::uint64_t place) {
    Grip grip = gripOf(sample, x, motion);
    grip.place = place;
    friction.add(grip);
  });
}

}  // namespace soft_tissue
