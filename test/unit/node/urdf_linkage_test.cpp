#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/urdf_files.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::ToolConfig;
using soft_tissue::Vec3;

/** A wrist on a slide on a turntable, with a finger that two others mimic, one in turn. */
constexpr const char* kWrist = R"(
  <link name="table"/>
  <link name="slide"/>
  <link name="palm"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  <link name="finger">
    <collision><geometry><box size="0.01 0.02 0.03"/></geometry></collision></link>
  <link name="thumb"><collision><geometry><sphere radius="0.002"/></geometry></collision></link>
  <link name="nail"><collision><origin xyz="0 0.01 0"/>
    <geometry><sphere radius="0.001"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.001"/></geometry></collision></link>
  <joint name="spin" type="continuous"><parent link="table"/><child link="slide"/>
    <axis xyz="0 0 2"/><limit velocity="4" effort="1"/></joint>
  <joint name="lift" type="prismatic"><parent link="slide"/><child link="palm"/>
    <origin xyz="0.1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="0.02" upper="0.3" velocity="0" effort="1"/></joint>
  <joint name="bend" type="revolute"><parent link="palm"/><child link="finger"/>
    <origin xyz="0 0 0.05" rpy="0 0 1.5"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" velocity="2" effort="1"/></joint>
  <joint name="oppose" type="revolute"><parent link="palm"/><child link="thumb"/>
    <origin xyz="0 0 0.04"/><axis xyz="0 1 0"/><mimic joint="bend" multiplier="-2" offset="0.1"/>
    <limit lower="-1.1" upper="3" velocity="3" effort="1"/></joint>
  <joint name="glue" type="fixed"><parent link="finger"/><child link="nail"/>
    <origin xyz="0 0 0.02"/></joint>
  <joint name="curl" type="prismatic"><parent link="thumb"/><child link="hook"/>
    <axis xyz="1 0 0"/><mimic joint="oppose" multiplier="0.01" offset="0.002"/>
    <limit lower="-9" upper="9" velocity="9" effort="1"/></joint>
)";

class Wrist : public UrdfTool
{
 protected:
  Wrist() : file_(writeUrdf(kWrist)) {}

  soft_tissue::JointValues values(std::initializer_list<double> list) const
  {
    soft_tissue::JointValues all(static_cast<Eigen::Index>(list.size()));
    std::copy(list.begin(), list.end(), all.data());
    return all;
  }

  std::string file_;
};

TEST_F(Wrist, hasTheJointsBetweenItsLinksAndFrame)
{
  const ToolConfig fingers = tool(file_, {"finger", "nail", "hook"}, "palm");
  ASSERT_EQ(fingers.linkage.coordinates().size(), 1u);
  EXPECT_EQ(fingers.linkage.coordinates()[0].name, "bend");
  EXPECT_EQ(fingers.linkage.links()[0].name, "palm");
  EXPECT_EQ(fingers.frame, 0u);
  EXPECT_FALSE(fingers.urdf.has_value());
  const ToolConfig all = tool(file_, {"hook"}, "table");
  ASSERT_EQ(all.linkage.coordinates().size(), 3u);
  EXPECT_EQ(all.linkage.coordinates()[0].name, "spin");
  EXPECT_EQ(all.linkage.coordinates()[1].name, "lift");
  EXPECT_EQ(tool(file_, {"palm"}).linkage.links().size(), 1u);
}

TEST_F(Wrist, keepsTheWayFromTheRootWhereThatStands)
{
  ToolConfig config;
  config.urdf = soft_tissue::UrdfShapeConfig{file_, {"palm"}, ""};
  config.pose_source.kind = soft_tissue::PoseSourceConfig::Kind::base;
  readUrdf(config, folder_.path());
  EXPECT_EQ(config.linkage.links()[0].name, "table");
  const auto X = config.linkage.pose(0, config.frame, values({0.7, 0.2}));
  EXPECT_LT((X.translation() - Vec3(0.1 * std::cos(0.7), 0.1 * std::sin(0.7), 0.2)).norm(), 1e-15);
}

TEST_F(Wrist, movesAsItsJointsSay)
{
  const ToolConfig config = tool(file_, {"finger", "thumb", "hook"}, "palm");
  const auto place = [&](const char* link, double bend, const Vec3& p) -> Vec3 {
    return config.linkage.pose(0, config.linkage.find(link), values({bend})) * p;
  };
  for (const double bend : {-0.5, 0.0, 0.4})
  {
    const Vec3 up = place("finger", bend, Vec3(0, 0, 0.02));
    const double out = -0.02 * std::sin(bend);  // along the finger's y, which is turned by 1.5
    EXPECT_LT(
        (up - Vec3(-out * std::sin(1.5), out * std::cos(1.5), 0.05 + 0.02 * std::cos(bend))).norm(),
        1e-15);
    const double oppose = -2.0 * bend + 0.1, curl = 0.01 * oppose + 0.002;
    EXPECT_LT((place("hook", bend, Vec3::Zero()) -
               Vec3(curl * std::cos(oppose), 0.0, 0.04 - curl * std::sin(oppose)))
                  .norm(),
              1e-15);
  }
}

TEST_F(Wrist, limitsAreThoseThatAllFollowersKeep)
{
  const ToolConfig config = tool(file_, {"hook"}, "table");
  const auto& joints = config.linkage.coordinates();
  EXPECT_EQ(joints[0].lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(joints[0].max_speed, 4.0);
  EXPECT_EQ(joints[1].lower, 0.02);
  EXPECT_EQ(joints[1].upper, 0.3);
  EXPECT_EQ(joints[1].max_speed, std::numeric_limits<double>::infinity()) << "zero: not told";
  // -1.1 <= -2 bend + 0.1 <= 3 leaves [-1, 0.6] of [-1, 1]; 2 |bend'| <= 3 is the slowest.
  EXPECT_NEAR(joints[2].lower, -1.0, 1e-15);
  EXPECT_NEAR(joints[2].upper, 0.6, 1e-15);
  EXPECT_EQ(joints[2].max_speed, 1.5);
}

TEST_F(Wrist, shapesAreOnTheirLinks)
{
  const ToolConfig config = tool(file_, {"finger", "nail", "thumb"}, "palm");
  ASSERT_EQ(config.shapes.size(), 3u);
  EXPECT_EQ(config.linkage.links()[config.shapes[1].link].name, "nail");
  EXPECT_EQ(config.linkage.carrier(config.shapes[1].link), config.shapes[0].link)
      << "moves with the finger";
  EXPECT_EQ(config.shapes[1].origin.position_m, Vec3(0, 0.01, 0));
}

TEST_F(Wrist, whatCantMoveIsNamed)
{
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kWrist;
    text.replace(text.find(from), from.size(), to);
    return complaint(writeUrdf(text), "hook", "table");
  };
  EXPECT_TRUE(contains(with("continuous", "floating"),
                       "joint 'spin' must be fixed, revolute, continuous or prismatic"));
  EXPECT_TRUE(contains(with("0 0 2", "0 0 0"), "joint 'spin' has an axis of length 0"));
  EXPECT_TRUE(contains(with("mimic joint=\"bend\"", "mimic joint=\"nose\""),
                       "joint 'oppose' mimics 'nose', which does not exist"));
  EXPECT_TRUE(contains(with("mimic joint=\"bend\"", "mimic joint=\"glue\""),
                       "joint 'oppose' mimics 'glue', which does not move"));
  EXPECT_TRUE(
      contains(with("mimic joint=\"bend\"", "mimic joint=\"curl\""), "which mimics it in turn"));
  EXPECT_TRUE(contains(with("lower=\"0.02\"", "lower=\"0.5\""),
                       "joint 'lift': lower limit 0.500000 must be at most the upper limit"));
  ToolConfig config;
  config.urdf = soft_tissue::UrdfShapeConfig{writeUrdf(kWrist), {"finger", "thumb"}, "palm"};
  config.jaw.emplace();
  config.jaw->joints = {{"oppose", 1.0}};
  try
  {
    readUrdf(config, folder_.path());
    FAIL();
  }
  catch (const soft_tissue::Error& error)
  {
    EXPECT_TRUE(contains(error.what(),
                         "jaw: there is no joint 'oppose' that moves the links by "
                         "itself; there are bend"))
        << error.what();
  }
}

}  // namespace
}  // namespace soft_tissue_sim
