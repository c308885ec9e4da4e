#include "soft_tissue_sim/node/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "support/tissue_scenes.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::ContactPoint;
using soft_tissue::Response;
using soft_tissue::Vec3;
using namespace soft_tissue::test;
using visualization_msgs::Marker;

/** Two blocks side by side that may touch each other and themselves; their contacts are made up. */
class PairMarkers : public testing::Test
{
 protected:
  PairMarkers()
      : scene_(config(folder_)),
        info_(scene_),
        depths_(info_, scene_.config()),
        builder_(info_, MarkerOptions())
  {
    scene_.fillSnapshot(snapshot_);
  }

  static soft_tissue::SceneConfig config(const soft_tissue::test::ScratchFolder& folder)
  {
    soft_tissue::SceneConfig config = blockScene(folder, {2, 2, 2});
    addTissue(config, "other", config.tissues[0].mesh.file, {1.0, 0.0, 0.0});
    addPair(config, "tissue", "other", Response::segment);
    addPair(config, "other", "other", Response::segment);
    return config;
  }

  /** So many contacts at (i, 0, 0), the force of the i-th along (0, 1, 1) and i + 1 times as
   * large. */
  static std::vector<ContactPoint> contacts(std::size_t count)
  {
    std::vector<ContactPoint> points(count);
    for (std::size_t i = 0; i < count; ++i)
    {
      const auto place = static_cast<double>(i);
      points[i].position_W = Vec3(place, 0.0, 0.0);
      points[i].force_W = (place + 1.0) * Vec3(0.0, 1.0, 1.0);
    }
    return points;
  }

  std::vector<Marker> arrows()
  {
    std::vector<Marker> found;
    for (const Marker& marker : builder_.build(snapshot_, depths_, {ros::Time(1), "world"}).markers)
    {
      if (marker.ns == "tissue_pairs")
      {
        found.push_back(marker);
      }
    }
    return found;
  }

  const soft_tissue::test::ScratchFolder folder_;
  soft_tissue::Scene scene_;
  SceneInfo info_;
  TissueDepths depths_;
  MarkerBuilder builder_;
  soft_tissue::Snapshot snapshot_;
};

TEST_F(PairMarkers, haveTheSameIdsHoweverManyContactsThereAre)
{
  const std::size_t most = 2 * kMaxContactArrows;
  for (const std::size_t count : {std::size_t{0}, std::size_t{3}, kMaxContactArrows + 7})
  {
    snapshot_.tissue_pairs[0].contacts = contacts(count);
    const std::vector<Marker> found = arrows();
    std::set<int> ids;
    std::size_t shown = 0;
    for (const Marker& marker : found)
    {
      ids.insert(marker.id);
      shown += marker.action == Marker::ADD ? 1 : 0;
      EXPECT_EQ(marker.header.frame_id, "world");
    }
    EXPECT_EQ(found.size(), most);
    EXPECT_EQ(ids.size(), most);
    EXPECT_EQ(*ids.rbegin() - *ids.begin() + 1, static_cast<int>(most));
    EXPECT_EQ(shown, std::min(count, kMaxContactArrows));
  }
}

TEST_F(PairMarkers, pointAlongTheForcesOnTheFirstInProportion)
{
  snapshot_.tissue_pairs[0].contacts = contacts(3);
  snapshot_.tissue_pairs[1].contacts = contacts(1);
  const std::vector<Marker> found = arrows();
  const auto check = [&](std::size_t marker, double place, double length) {
    ASSERT_EQ(found[marker].points.size(), 2u);
    const auto& from = found[marker].points[0];
    const auto& to = found[marker].points[1];
    EXPECT_EQ(from.x, place);
    const Vec3 expected = length / std::sqrt(2.0) * Vec3(0.0, 1.0, 1.0);
    EXPECT_LT((Vec3(to.x - from.x, to.y - from.y, to.z - from.z) - expected).norm(), 1e-15);
  };
  check(0, 2.0, 0.015);
  check(1, 1.0, 0.010);
  check(2, 0.0, 0.005);
  check(kMaxContactArrows, 0.0, 0.015);  // the longest of the other pair
}

}  // namespace
}  // namespace soft_tissue_sim
