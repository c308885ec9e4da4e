#include "soft_tissue_sim/base/series.h"

namespace soft_tissue
{
Pose interpolate(const Pose& a, const Pose& b, double s)
{
  if (s <= 0.0)
  {
    return a;
  }
  if (s >= 1.0)
  {
    return b;
  }
  Pose pose = Pose::Identity();
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  pose.linear() = qa.slerp(s, qb).toRotationMatrix();
  pose.translation() = (1.0 - s) * a.translation() + s * b.translation();
  return pose;
}

JointValues interpolate(const JointValues& a, const JointValues& b, double s)
{
  if (s <= 0.0)
  {
    return a;
  }
  return s >= 1.0 ? b : JointValues((1.0 - s) * a + s * b);
}

}  // namespace soft_tissue
