#include "soft_tissue_sim/collision/clip_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "soft_tissue_sim/collision/clip_kernels.h"
#include "soft_tissue_sim/collision/segment_filter.h"
#include "soft_tissue_sim/geometry/clip.h"
#include "support/pair_bodies.h"

namespace soft_tissue::test
{
namespace
{
std::vector<ElementPair> everyPair(const ElementSet& first, const ElementSet& second)
{
  std::vector<ElementPair> pairs;
  for (Index j = 0; j < second.count; ++j)
  {
    for (Index i = 0; i < first.count; ++i)
    {
      pairs.push_back({i, j});
    }
  }
  return pairs;
}

std::vector<ClippedPair> oneByOne(const ElementSet& segments, const Points& x_segments,
                                  const PairBody& body, const Points& x,
                                  const std::vector<ElementPair>& pairs)
{
  std::vector<ClippedPair> pieces;
  for (const ElementPair& pair : pairs)
  {
    const Tet& t = body.mesh.tets[pair.second];
    const auto coordinates = tetCoordinates(x[t[0]], x[t[1]], x[t[2]], x[t[3]]);
    const Index* const ends = segments.nodes + pair.first * segments.nodes_each;
    const Vec3 &a = x_segments[ends[0]], &b = x_segments[ends[segments.nodes_each - 1]];
    const auto piece = coordinates ? clipSegment(a, b, *coordinates) : std::nullopt;
    if (piece && piece->lambda1 < piece->lambda2)
    {
      pieces.push_back({pair, {piece->lambda1, piece->lambda2}});
    }
  }
  return pieces;
}

/** Where a corner is touched, rounding decides whether there is a piece. */
std::vector<ClippedPair> longOnes(std::vector<ClippedPair> pieces)
{
  const auto isShort = [](const ClippedPair& one) {
    return one.where.end - one.where.begin < 1e-9;
  };
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(), isShort), pieces.end());
  return pieces;
}

void expectSame(const std::vector<ClippedPair>& found, const std::vector<ClippedPair>& wanted)
{
  const std::vector<ClippedPair> pieces = longOnes(found), expected = longOnes(wanted);
  ASSERT_EQ(pieces.size(), expected.size());
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    EXPECT_EQ(pieces[i].pair.first, expected[i].pair.first);
    EXPECT_EQ(pieces[i].pair.second, expected[i].pair.second);
    EXPECT_NEAR(pieces[i].where.begin, expected[i].where.begin, 1e-12);
    EXPECT_NEAR(pieces[i].where.end, expected[i].where.end, 1e-12);
  }
}
}  // namespace

TEST(ClipPairs, FindsWhatClippingOneByOneFinds)
{
  for (const PairMeeting& m : pairMeetings())
  {
    std::vector<Index> nodes(m.x_a.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    const ElementSet points = {nodes.data(), 1, static_cast<Index>(nodes.size())};
    for (const ElementSet& segments : {m.a.edges(), points})
    {
      std::vector<ElementPair> every = everyPair(segments, m.b.tets());
      const auto expected = oneByOne(segments, m.x_a, m.b, m.x_b, every);
      std::vector<ClippedPair> pieces = {{{7, 7}, {}}};
      clipPairs(segments, m.x_a.data(), m.b.tets(), m.x_b.data(), every, pieces);
      expectSame(pieces, expected);
      EXPECT_GT(pieces.size(), 0u);
      every.resize(3);  // fewer than are clipped together
      clipPairs(segments, m.x_a.data(), m.b.tets(), m.x_b.data(), every, pieces);
      expectSame(pieces, oneByOne(segments, m.x_a, m.b, m.x_b, every));
      clipPairs(segments, m.x_a.data(), m.b.tets(), m.x_b.data(), {}, pieces);
      EXPECT_TRUE(pieces.empty());
    }
  }
}

TEST(ClipPairs, HoldsNothingInFlatTets)
{
  Points x = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  const Points ends = {Vec3(0.1, 0.1, -1.0), Vec3(0.1, 0.1, 1.0)};
  const std::vector<Index> corners = {0, 1, 2, 3}, edge = {0, 1};
  const auto count = [&] {
    std::vector<ClippedPair> pieces;
    clipPairs({edge.data(), 2, 1}, ends.data(), {corners.data(), 4, 1}, x.data(), {{0, 0}}, pieces);
    return pieces.size();
  };
  EXPECT_EQ(count(), 1u);
  for (const double height : {0.0, 1e-13, std::nan(""), HUGE_VAL})
  {
    x[3].z() = height;
    EXPECT_EQ(count(), 0u) << height;
    EXPECT_FALSE(tetCoordinates(x[0], x[1], x[2], x[3])) << height;
  }
}

TEST(ClipPairs, AreTheSameToTheBitOnEveryMachine)
{
  for (const PairMeeting& m : pairMeetings())
  {
    const std::vector<ElementPair> every = everyPair(m.a.edges(), m.b.tets());
    std::vector<ClippedPair> plain(every.size()), best(every.size());
    const auto clip = [&](InstructionSet set, std::vector<ClippedPair>& pieces) {
      pieces.resize(clipKernel(set)(m.a.edges(), m.x_a.data(), m.b.tets(), m.x_b.data(),
                                    every.data(), static_cast<Index>(every.size()), pieces.data()));
    };
    clip(InstructionSet::baseline, plain);
    clip(instructionSet(), best);
    ASSERT_EQ(plain.size(), best.size());
    for (std::size_t i = 0; i < plain.size(); ++i)
    {
      EXPECT_EQ(plain[i].where.begin, best[i].where.begin);
      EXPECT_EQ(plain[i].where.end, best[i].where.end);
    }
  }
}

TEST(SegmentFilter, LeavesAllThatMeetInOrder)
{
  for (const PairMeeting& m : pairMeetings())
  {
    const std::vector<ElementPair> every = everyPair(m.a.edges(), m.b.tets());
    std::size_t before = 0;
    for (const double margin : {0.0, 0.05, 0.2})
    {
      std::vector<ElementPair> left = every;
      dropParted(m.a.edges(), m.x_a.data(), m.b.tets(), m.x_b.data(), margin, left);
      expectSame(oneByOne(m.a.edges(), m.x_a, m.b, m.x_b, left),
                 oneByOne(m.a.edges(), m.x_a, m.b, m.x_b, every));
      EXPECT_GE(left.size(), before);
      EXPECT_LT(left.size(), every.size() / 2);
      before = left.size();
    }
  }
}

}  // namespace soft_tissue::test
