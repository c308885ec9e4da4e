#pragma once

#include <limits>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/series.h"

namespace soft_tissue
{
/** A number that sets joints, by name that of one of them. */
struct Coordinate
{
  std::string name;
  double lower = -std::numeric_limits<double>::infinity();     ///< rad or m
  double upper = std::numeric_limits<double>::infinity();      ///< rad or m
  double max_speed = std::numeric_limits<double>::infinity();  ///< rad/s or m/s
};

enum class JointKind
{
  fixed,
  turning,  ///< about its axis, rad
  sliding,  ///< along its axis, m
};

/** A rigid part of a linkage and the joint that it hangs on. */
struct Link
{
  std::string name;
  std::size_t parent = 0;        ///< the link the joint stands on
  Pose X_PJ = Pose::Identity();  ///< where, in that link's frame: this link's at a value of zero
  JointKind kind = JointKind::fixed;
  Vec3 axis_J = Vec3::UnitX();  ///< unit
  std::size_t coordinate = 0;   ///< that sets the joint, unless it is fixed
  double factor = 1.0;          ///< its value is factor times the coordinate
  double offset = 0.0;          ///< and this added, rad or m
};

/** Rigid links that hang on one another by joints, as a tree. */
class Linkage
{
 public:
  /** One link alone, the root, without a name. */
  Linkage() : Linkage("") {}
  explicit Linkage(std::string root);

  /** @return its number @throws Error beyond kMostJoints, or unless the lower limit is at most the
   * upper one and the speed is positive */
  std::size_t add(const Coordinate& coordinate);
  /** @return its number @throws Error unless its parent and, if it moves, its coordinate are there
   * and its axis is unit */
  std::size_t add(const Link& link);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  const std::vector<Link>& links() const { return links_; }

  /** Number of the link of a name; that of links() if there is none. */
  std::size_t find(const std::string& link) const;
  /** Number of the coordinate of a name; that of coordinates() if there is none. */
  std::size_t findCoordinate(const std::string& name) const;

  /** The link itself or the nearest one before it on the way to the root that a joint moves, or the
   * root: both always keep their places to each other. */
  std::size_t carrier(std::size_t link) const;

  /** Pose of a link in another's frame. @param values  one per coordinate */
  Pose pose(std::size_t in, std::size_t link, const JointValues& values) const;

  /** The nearest values within the limits; what is no number stays what it is in `instead`. */
  JointValues within(const JointValues& values, const JointValues& instead) const;

 private:
  Pose inRoot(std::size_t link, const JointValues& values) const;

  std::vector<Coordinate> coordinates_;
  std::vector<Link> links_;
};

}  // namespace soft_tissue
