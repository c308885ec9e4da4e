#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>

#include "soft_tissue_sim/node/message_builders.h"
#include "support/tissue_scenes.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::ContactPoint;
using soft_tissue::Index;
using soft_tissue::Points;
using soft_tissue::Response;
using soft_tissue::Scene;
using soft_tissue::Snapshot;
using soft_tissue::Vec3;
using namespace soft_tissue::test;

constexpr double kBallRadius = 0.008;  // m
constexpr double kSize = 0.018;        // m, of the small block
constexpr double kOverlap = 0.0005;    // m

/** A small block, "above", is half a millimetre deep in a larger one, "tissue", and so is a ball,
 * "tool", in the small one; above touches itself, too. */
class Stack : public testing::Test
{
 protected:
  Stack() : scene_(config(folder_)), info_(scene_)
  {
    scene_.step();
    scene_.fillSnapshot(snapshot_);
  }

  static soft_tissue::SceneConfig config(const soft_tissue::test::ScratchFolder& folder)
  {
    soft_tissue::SceneConfig config = blockScene(folder, {6, 6, 3});
    addTissue(config, "above",
              saved(folder, "above.msh", soft_tissue::makeBox({3, 3, 3}, Vec3::Constant(kSize))),
              {-0.5 * kSize, -0.5 * kSize, kBlockTop - kOverlap});
    addPair(config, "above", "tissue", Response::segment);
    addPair(config, "above", "above", Response::segment);
    soft_tissue::PoseConfig pose;
    pose.position_m.z() = kBlockTop + kSize - 2.0 * kOverlap + kBallRadius;
    addTool(config, soft_tissue::SphereShape{kBallRadius}, pose, Response::segment);
    config.contacts.back().tissue = "above";
    return config;
  }

  static ContactPoint point(const Vec3& position, double depth, double area, const Vec3& force,
                            Index tissue, Index tet)
  {
    return {position, Vec3::UnitZ(), depth, area, force, tissue, tet};
  }

  /** Whether a point is in a tet of a tissue, but for rounding. */
  bool inTet(const geometry_msgs::Point& p, std::size_t tissue, std::int32_t tet) const
  {
    const Points& x = snapshot_.tissues[tissue].positions;
    const soft_tissue::Tet& nodes = info_.tissues[tissue].rest.tets[static_cast<std::size_t>(tet)];
    Eigen::Matrix4d corners;
    for (int k = 0; k < 4; ++k)
    {
      corners.col(k) << x[nodes[k]], 1.0;
    }
    const Eigen::Vector4d weights = corners.inverse() * Eigen::Vector4d(p.x, p.y, p.z, 1.0);
    return weights.minCoeff() > -1e-6;
  }

  const soft_tissue::test::ScratchFolder folder_;
  Scene scene_;
  SceneInfo info_;
  Snapshot snapshot_;
  Stamp stamp_{ros::Time(3.5), "world"};
};

TEST_F(Stack, pairsAreNamedInTheOrderOfTheirStates)
{
  ASSERT_EQ(info_.tissue_pairs.size(), 2u);
  ASSERT_EQ(snapshot_.tissue_pairs.size(), 2u);
  EXPECT_EQ(info_.tissue_pairs[0].name, "above/tissue");
  EXPECT_EQ(info_.tissue_pairs[1].name, "above/above");
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_EQ(info_.tissue_pairs[i].first,
              static_cast<std::size_t>(snapshot_.tissue_pairs[i].first));
    EXPECT_EQ(info_.tissue_pairs[i].second,
              static_cast<std::size_t>(snapshot_.tissue_pairs[i].second));
  }
}

TEST_F(Stack, aMessageHoldsThePointsOfAllPairs)
{
  snapshot_.tissue_pairs[0].contacts = {
      point({1, 2, 3}, 0.25, 0.5, {7, 8, 4}, 0, 11),   // of the first tissue
      point({4, 5, 6}, 0.0, 0.0, {0.1, 0, 0}, 1, -1),  // friction
  };
  snapshot_.tissue_pairs[1].contacts = {point({7, 8, 9}, 0.125, 2.0, {0, 0, 6}, 1, 12)};
  const TissueContacts message = tissueContactsMessage(info_, snapshot_, stamp_);
  EXPECT_EQ(message.header.stamp, stamp_.time);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.tissue_names, (std::vector<std::string>{"tissue", "above"}));
  EXPECT_EQ(message.firsts, (std::vector<std::uint32_t>{1, 1, 1}));
  EXPECT_EQ(message.seconds, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(message.hosts, (std::vector<std::uint32_t>{0, 1, 1}));
  EXPECT_EQ(message.tets, (std::vector<std::int32_t>{11, -1, 12}));
  EXPECT_EQ(message.depths, (std::vector<double>{0.25, 0.0, 0.125}));
  EXPECT_EQ(message.areas, (std::vector<double>{0.5, 0.0, 2.0}));
  EXPECT_EQ(message.pressures, (std::vector<double>{8.0, 0.0, 3.0}));  // 4 / 0.5, -, 6 / 2
  ASSERT_EQ(message.points.size(), 3u);
  ASSERT_EQ(message.normals.size(), 3u);
  ASSERT_EQ(message.forces.size(), 3u);
  EXPECT_EQ(message.points[1].y, 5.0);
  EXPECT_EQ(message.normals[2].z, 1.0);
  EXPECT_EQ(message.forces[0].x, 7.0);
}

TEST_F(Stack, pointsBetweenTissuesLieInTheTetsTheyName)
{
  const TissueContacts message = tissueContactsMessage(info_, snapshot_, stamp_);
  std::array<int, 2> in_host = {0, 0};
  for (std::size_t i = 0; i < message.tets.size(); ++i)
  {
    ASSERT_GE(message.tets[i], 0);
    EXPECT_TRUE(inTet(message.points[i], message.hosts[i], message.tets[i])) << "point " << i;
    ++in_host[message.hosts[i]];
  }
  EXPECT_GT(in_host[0], 0);
  EXPECT_GT(in_host[1], 0);
}

TEST_F(Stack, pointsOfAToolLieInTheTetTheyNameOrInTheTool)
{
  const ToolContacts message = contactsMessage(info_, snapshot_, 0, stamp_);
  const Vec3 centre = snapshot_.tools[0].X_WT.translation();
  int in_tet = 0, in_tool = 0;
  for (std::size_t i = 0; i < message.tets.size(); ++i)
  {
    const geometry_msgs::Point& p = message.points[i];
    if (message.tets[i] >= 0)
    {
      ++in_tet;
      EXPECT_TRUE(inTet(p, message.tissues[i], message.tets[i])) << "point " << i;
    }
    else
    {
      ++in_tool;
      EXPECT_LT((Vec3(p.x, p.y, p.z) - centre).norm(), kBallRadius + 1e-9) << "point " << i;
    }
  }
  EXPECT_EQ(message.tets.size(), message.points.size());
  EXPECT_GT(in_tet, 0);
  EXPECT_GT(in_tool, 0);
}

}  // namespace
}  // namespace soft_tissue_sim
