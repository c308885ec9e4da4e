#include "soft_tissue_sim/collision/overlapping_tets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/geometry/tet_overlap.h"
#include "support/pair_bodies.h"

namespace soft_tissue::test
{
namespace
{
std::array<Vec3, 4> cornersOf(const PairBody& body, Index tet, const Points& x)
{
  const Tet& t = body.mesh.tets[tet];
  return {x[t[0]], x[t[1]], x[t[2]], x[t[3]]};
}

}  // namespace

TEST(OverlappingTets, AreThoseThatSeparatingAxesTell)
{
  for (const PairMeeting& m : pairMeetings())
  {
    std::vector<ElementPair> every, expected, pairs = {{7, 7}};
    for (Index j = 0; j < m.b.tets().count; ++j)
    {
      for (Index i = 0; i < m.a.tets().count; ++i)
      {
        every.push_back({i, j});
        if (tetsOverlap(cornersOf(m.a, i, m.x_a), cornersOf(m.b, j, m.x_b)))
        {
          expected.push_back(every.back());
        }
      }
    }
    findOverlappingTets(m.a.tets(), m.x_a.data(), m.b.tets(), m.x_b.data(), every, pairs);
    EXPECT_EQ(sortedPairs(pairs), sortedPairs(expected));
    EXPECT_GT(pairs.size(), 0u);
    every.resize(3);  // fewer than are looked at together
    findOverlappingTets(m.a.tets(), m.x_a.data(), m.b.tets(), m.x_b.data(), every, pairs);
    EXPECT_LE(pairs.size(), 3u);
    findOverlappingTets(m.a.tets(), m.x_a.data(), m.b.tets(), m.x_b.data(), {}, pairs);
    EXPECT_TRUE(pairs.empty());
  }
}

}  // namespace soft_tissue::test
