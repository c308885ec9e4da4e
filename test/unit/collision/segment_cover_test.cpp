#include "soft_tissue_sim/collision/segment_cover.h"

#include <gtest/gtest.h>

namespace soft_tissue
{
TEST(SegmentCover, GivesEveryPointToOneTet)
{
  SegmentCover cover;
  cover.reset(2);
  EXPECT_TRUE(cover.empty());
  cover.add(0, 7, {0.4, 0.9});
  cover.add(0, 3, {0.4, 0.9});  // the same stretch, as for a segment in a shared face
  cover.add(0, 5, {0.1, 0.5});  // overlaps its end
  cover.add(0, 6, {0.2, 0.3});  // inside another
  cover.add(0, 8, {0.95, 1.0});
  const auto& pieces = cover.disjointPieces(0);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].host, 5);
  EXPECT_EQ(pieces[0].where.begin, 0.1);
  EXPECT_EQ(pieces[0].where.end, 0.5);
  EXPECT_EQ(pieces[1].host, 3);
  EXPECT_EQ(pieces[1].where.begin, 0.5);
  EXPECT_EQ(pieces[1].where.end, 0.9);
  EXPECT_EQ(pieces[2].host, 8);
  EXPECT_TRUE(cover.disjointPieces(1).empty());
}

TEST(SegmentCover, ForgetsOnReset)
{
  SegmentCover cover;
  cover.reset(1);
  cover.add(0, 0, {0.0, 1.0});
  EXPECT_FALSE(cover.empty());
  cover.reset(3);
  EXPECT_TRUE(cover.empty());
  EXPECT_TRUE(cover.disjointPieces(0).empty());
}

}  // namespace soft_tissue
