#include "soft_tissue_sim/geometry/linkage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** A link in the frame of the one it hangs on. */
Pose inParent(const Link& link, const JointValues& values)
{
  Pose X_PL = link.X_PJ;
  if (link.kind == JointKind::fixed)
  {
    return X_PL;
  }
  const double value =
      link.factor * values[static_cast<Eigen::Index>(link.coordinate)] + link.offset;
  if (link.kind == JointKind::turning)
  {
    X_PL.rotate(Eigen::AngleAxisd(value, link.axis_J));
  }
  else
  {
    X_PL.translate(value * link.axis_J);
  }
  return X_PL;
}

template <typename Named>
std::size_t numberOf(const std::vector<Named>& all, const std::string& name)
{
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}
}  // namespace

Linkage::Linkage(std::string root)
{
  links_.emplace_back();
  links_[0].name = std::move(root);
}

std::size_t Linkage::add(const Coordinate& coordinate)
{
  if (coordinates_.size() == static_cast<std::size_t>(kMostJoints))
  {
    throw Error("joint '" + coordinate.name + "': more than " + std::to_string(kMostJoints) +
                " joints of one tool that move by themselves");
  }
  if (!(coordinate.lower <= coordinate.upper))
  {
    throw Error("joint '" + coordinate.name + "': lower limit " + std::to_string(coordinate.lower) +
                " must be at most the upper limit " + std::to_string(coordinate.upper));
  }
  if (!(coordinate.max_speed > 0.0))
  {
    throw Error("joint '" + coordinate.name + "': greatest speed " +
                std::to_string(coordinate.max_speed) + " must be > 0");
  }
  coordinates_.push_back(coordinate);
  return coordinates_.size() - 1;
}

std::size_t Linkage::add(const Link& link)
{
  constexpr double kUnit = 1e-9;
  if (link.parent >= links_.size())
  {
    throw Error("link '" + link.name + "': hangs on a link that is not there");
  }
  if (link.kind != JointKind::fixed && link.coordinate >= coordinates_.size())
  {
    throw Error("link '" + link.name + "': its joint has no value");
  }
  if (!(std::abs(link.axis_J.norm() - 1.0) <= kUnit))
  {
    throw Error("link '" + link.name + "': the axis of its joint must have length 1");
  }
  links_.push_back(link);
  return links_.size() - 1;
}

std::size_t Linkage::find(const std::string& link) const
{
  return numberOf(links_, link);
}

std::size_t Linkage::findCoordinate(const std::string& name) const
{
  return numberOf(coordinates_, name);
}

std::size_t Linkage::carrier(std::size_t link) const
{
  while (link != 0 && links_[link].kind == JointKind::fixed)
  {
    link = links_[link].parent;
  }
  return link;
}

Pose Linkage::inRoot(std::size_t link, const JointValues& values) const
{
  Pose X_RL = Pose::Identity();
  for (; link != 0; link = links_[link].parent)
  {
    X_RL = inParent(links_[link], values) * X_RL;
  }
  return X_RL;
}

Pose Linkage::pose(std::size_t in, std::size_t link, const JointValues& values) const
{
  return in == link ? Pose::Identity() : inRoot(in, values).inverse() * inRoot(link, values);
}

JointValues Linkage::within(const JointValues& values, const JointValues& instead) const
{
  JointValues inside = instead;
  for (Eigen::Index k = 0; k < inside.size(); ++k)
  {
    const Coordinate& coordinate = coordinates_[static_cast<std::size_t>(k)];
    inside[k] = std::clamp(std::isnan(values[k]) ? instead[k] : values[k], coordinate.lower,
                           coordinate.upper);
  }
  return inside;
}

}  // namespace soft_tissue
