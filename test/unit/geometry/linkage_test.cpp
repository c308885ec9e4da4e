#include "soft_tissue_sim/geometry/linkage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
const double kNan = std::nan("");

Pose at(double x, double y, double z)
{
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, z);
  return X;
}

JointValues values(std::initializer_list<double> list)
{
  JointValues all(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), all.data());
  return all;
}

Link link(const std::string& name, std::size_t parent, const Pose& X_PJ, JointKind kind,
          const Vec3& axis = Vec3::UnitZ(), std::size_t coordinate = 0)
{
  Link one;
  one.name = name;
  one.parent = parent;
  one.X_PJ = X_PJ;
  one.kind = kind;
  one.axis_J = axis;
  one.coordinate = coordinate;
  return one;
}

/** Two arms in the plane with a plate on the second, and a slide that follows the second joint. */
struct Arm
{
  Linkage linkage{"base"};
  std::size_t shoulder, elbow, upper, lower, plate, slide;

  Arm()
  {
    shoulder = linkage.add(Coordinate{"shoulder", -1.0, 2.0, 3.0});
    elbow = linkage.add(Coordinate{"elbow"});
    upper = linkage.add(link("upper", 0, at(0, 0, 0.5), JointKind::turning, Vec3::UnitZ()));
    lower =
        linkage.add(link("lower", upper, at(0.3, 0, 0), JointKind::turning, Vec3::UnitZ(), elbow));
    plate = linkage.add(link("plate", lower, at(0.2, 0, 0), JointKind::fixed));
    Link follower = link("slide", plate, at(0, 0, 0), JointKind::sliding, Vec3::UnitY(), elbow);
    follower.factor = -0.5;
    follower.offset = 0.1;
    slide = linkage.add(follower);
  }
};

TEST(Linkage, PutsAnArmWhereTrigonometryHasIt)
{
  const Arm arm;
  const double a = 0.4, b = -1.1;
  const Pose plate = arm.linkage.pose(0, arm.plate, values({a, b}));
  const Vec3 expected(0.3 * std::cos(a) + 0.2 * std::cos(a + b),
                      0.3 * std::sin(a) + 0.2 * std::sin(a + b), 0.5);
  EXPECT_LT((plate.translation() - expected).norm(), 1e-15);
  const Mat3 turned = Eigen::AngleAxisd(a + b, Vec3::UnitZ()).toRotationMatrix();
  EXPECT_LT((plate.linear() - turned).norm(), 1e-15);
}

TEST(Linkage, AFollowerGoesByItsShareAndOffset)
{
  const Arm arm;
  for (const double b : {-1.0, 0.0, 0.7})
  {
    const Pose slide = arm.linkage.pose(arm.plate, arm.slide, values({0.3, b}));
    EXPECT_LT((slide.translation() - Vec3(0, 0.1 - 0.5 * b, 0)).norm(), 1e-15) << b;
    EXPECT_LT((slide.linear() - Mat3::Identity()).norm(), 1e-15);
  }
}

TEST(Linkage, PosesInOtherFramesAreThoseOfTheRootTakenApart)
{
  const Arm arm;
  const JointValues q = values({0.2, 0.9});
  const Pose there = arm.linkage.pose(arm.slide, arm.upper, q);
  const Pose back = arm.linkage.pose(arm.upper, arm.slide, q);
  EXPECT_TRUE((there * back).isApprox(Pose::Identity(), 1e-14));
  EXPECT_TRUE((arm.linkage.pose(0, arm.slide, q) * there)
                  .isApprox(arm.linkage.pose(0, arm.upper, q), 1e-14));
  EXPECT_TRUE(arm.linkage.pose(arm.plate, arm.plate, q).isApprox(Pose::Identity(), 0.0));
}

TEST(Linkage, FixedLinksAreCarriedByTheLinkThatMoves)
{
  const Arm arm;
  EXPECT_EQ(arm.linkage.carrier(arm.plate), arm.lower);
  EXPECT_EQ(arm.linkage.carrier(arm.lower), arm.lower);
  EXPECT_EQ(arm.linkage.carrier(arm.slide), arm.slide);
  Linkage stiff("root");
  const std::size_t first = stiff.add(link("a", 0, at(1, 0, 0), JointKind::fixed));
  EXPECT_EQ(stiff.carrier(stiff.add(link("b", first, at(1, 0, 0), JointKind::fixed))), 0u);
}

TEST(Linkage, LimitsHoldAndWhatIsNoNumberStays)
{
  const Arm arm;
  const JointValues before = values({0.5, 0.25});
  EXPECT_EQ(arm.linkage.within(values({5.0, 9.0}), before), values({2.0, 9.0}));
  EXPECT_EQ(arm.linkage.within(values({-5.0, kNan}), before), values({-1.0, 0.25}));
  EXPECT_EQ(arm.linkage.within(values({kNan, -3.0}), before), values({0.5, -3.0}));
}

TEST(Linkage, NamesAreFound)
{
  const Arm arm;
  EXPECT_EQ(arm.linkage.find("plate"), arm.plate);
  EXPECT_EQ(arm.linkage.find("nose"), arm.linkage.links().size());
  EXPECT_EQ(arm.linkage.findCoordinate("elbow"), arm.elbow);
  EXPECT_EQ(arm.linkage.findCoordinate("slide"), arm.linkage.coordinates().size());
}

TEST(Linkage, RefusesWhatCantMove)
{
  Linkage linkage("base");
  EXPECT_THROW(linkage.add(Coordinate{"a", 1.0, 0.5}), Error);
  EXPECT_THROW(linkage.add(Coordinate{"a", 0.0, kNan}), Error);
  EXPECT_THROW(linkage.add(Coordinate{"a", 0.0, 1.0, 0.0}), Error);
  EXPECT_THROW(linkage.add(link("a", 1, at(0, 0, 0), JointKind::fixed)), Error);
  EXPECT_THROW(linkage.add(link("a", 0, at(0, 0, 0), JointKind::turning)), Error);
  linkage.add(Coordinate{"a"});
  EXPECT_THROW(linkage.add(link("a", 0, at(0, 0, 0), JointKind::turning, Vec3(0, 0, 2))), Error);
  EXPECT_THROW(linkage.add(link("a", 0, at(0, 0, 0), JointKind::turning, Vec3(0, 0, 0))), Error);
  for (int k = 1; k < kMostJoints; ++k)
  {
    linkage.add(Coordinate{"b"});
  }
  EXPECT_THROW(linkage.add(Coordinate{"one too many"}), Error);
}

}  // namespace
}  // namespace soft_tissue
