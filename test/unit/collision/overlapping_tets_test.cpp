#include "soft_tissue_sim/collision/overlapping_tets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/collision/segment_filter.h"
#include "soft_tissue_sim/geometry/clip.h"
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

/** Balls in each other, and boxes of cubes that touch along whole faces, one with a bad node. */
struct Meetings
{
  PairBody a, b;
  Points x_a, x_b;
};

std::vector<Meetings> meetings()
{
  const PairBody ball(makeBall(1.0, 600)), box(makeBox({3, 3, 3}, Vec3::Ones()));
  std::vector<Meetings> all = {{ball, ball, ball.x, ball.moved(Vec3(1.5, 0.1, 0.05))},
                               {box, box, box.x, box.moved(Vec3(1.0, 0.0, 0.0))},
                               {box, box, box.x, box.moved(Vec3(2.0 / 3.0, 1.0 / 3.0, 0.0))},
                               {box, box, box.x, box.moved(Vec3(0.5, 0.0, 0.0))}};
  all[3].x_b[5].y() = std::nan("");
  return all;
}
}  // namespace

TEST(OverlappingTets, AreThoseThatSeparatingAxesTell)
{
  for (const Meetings& m : meetings())
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

TEST(SegmentFilter, LeavesAllThatMeetInOrder)
{
  SegmentFilter filter;
  for (const Meetings& m : meetings())
  {
    filter.clear();
    std::vector<char> hit;
    for (Index j = 0; j < m.b.tets().count; ++j)
    {
      const std::array<Vec3, 4> p = cornersOf(m.b, j, m.x_b);
      const auto coordinates = tetCoordinates(p[0], p[1], p[2], p[3]);
      filter.setTet(p[0], p[1], p[2], p[3]);
      for (const Edge& edge : m.a.surface.edges)
      {
        const Vec3 &begin = m.x_a[edge[0]], &end = m.x_a[edge[1]];
        filter.add(static_cast<Index>(hit.size()), begin, end);
        hit.push_back(coordinates && clipSegment(begin, end, *coordinates));
      }
    }
    std::vector<char> left(hit.size(), 0);
    Index before = -1;
    for (const Index number : filter.left())
    {
      EXPECT_GT(number, before);
      before = number;
      left[number] = 1;
    }
    std::size_t hits = 0;
    for (std::size_t i = 0; i < hit.size(); ++i)
    {
      hits += hit[i];
      EXPECT_LE(hit[i], left[i]) << i;
    }
    EXPECT_GT(hits, 0u);
    EXPECT_LT(filter.left().size(), hit.size() / 4);
  }
}

}  // namespace soft_tissue::test
