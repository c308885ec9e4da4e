#include "soft_tissue_sim/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/error.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

struct Soup
{
  Points x;
  std::vector<Triangle> triangles;
};

/** Triangles of all sorts: of this size, some of them needles, points and copies of each other. */
Soup randomSoup(RandomGeometry& random, int count, double size)
{
  Soup soup;
  for (int i = 0; i < count; ++i)
  {
    const Index first = static_cast<Index>(soup.x.size());
    const Vec3 centre = random.point(1.0);
    const Vec3 side = random.point(size);
    for (int k = 0; k < 3; ++k)
    {
      const bool needle = i % 7 == 3, point = i % 11 == 5;
      soup.x.push_back(point ? centre
                       : needle
                           ? Vec3(centre + k * side + random.point(i % 2 == 0 ? 0.0 : 1e-5 * size))
                           : centre + random.point(size));
    }
    soup.triangles.push_back({first, first + 1, first + 2});
    if (i % 13 == 7)
    {
      soup.triangles.push_back(soup.triangles.back());
    }
  }
  return soup;
}

bool all(Index /*triangle*/)
{
  return true;
}

/** The oracle: of all triangles that are allowed, one after the other. */
template <typename Allowed = bool (*)(Index)>
TriangleTree::Nearest bruteForce(const Soup& soup, const Vec3& p, const Allowed& allowed = all)
{
  TriangleTree::Nearest nearest;
  nearest.point.squared_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < soup.triangles.size(); ++i)
  {
    const Triangle& t = soup.triangles[i];
    const TrianglePoint point = closestOnTriangle(p, soup.x[t[0]], soup.x[t[1]], soup.x[t[2]]);
    if (allowed(static_cast<Index>(i)) && point.squared_distance < nearest.point.squared_distance)
    {
      nearest.point = point;
      nearest.triangle = static_cast<Index>(i);
    }
  }
  return nearest;
}

void expectNearest(const TriangleTree& tree, const Soup& soup, RandomGeometry& random)
{
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 p = i % 5 == 0 ? soup.x[i % soup.x.size()] : random.point(i % 3 == 0 ? 10.0 : 1.2);
    const TriangleTree::Nearest exact = bruteForce(soup, p);
    for (const Index hint : {-1, i % static_cast<Index>(soup.triangles.size()), exact.triangle})
    {
      const TriangleTree::Nearest found = tree.nearest(p, soup.x, hint);
      EXPECT_EQ(found.triangle, exact.triangle);
      EXPECT_EQ(found.point.squared_distance, exact.point.squared_distance);
      EXPECT_EQ(found.point.point, exact.point.point);
    }
  }
}

TEST(TriangleTree, FindsTheNearestOfAllToTheBit)
{
  RandomGeometry random(1);
  const InstructionSet best = instructionSet();
  for (const int count : {1, 2, 4, 5, 16, 17, 63, 64, 65, 300, 1500})
  {
    for (const double size : {0.02, 0.5})
    {
      const Soup soup = randomSoup(random, count, size);
      for (const InstructionSet set : {InstructionSet::baseline, best})
      {
        forceInstructionSet(set);
        TriangleTree tree;
        tree.build(soup.triangles, soup.x);
        expectNearest(tree, soup, random);
      }
      forceInstructionSet(best);
    }
  }
}

TEST(TriangleTree, FollowsItsNodesHoweverTheyMove)
{
  RandomGeometry random(2);
  Soup soup = randomSoup(random, 400, 0.1);
  TriangleTree tree;
  tree.build(soup.triangles, soup.x);
  for (const double far : {0.01, 0.3, 5.0})
  {
    for (Vec3& p : soup.x)
    {
      p += random.point(far);
    }
    tree.refit(soup.x);
    expectNearest(tree, soup, random);
    for (const Vec3& p : soup.x)
    {
      EXPECT_TRUE(tree.bounds().contains(p));
    }
  }
}

TEST(TriangleTree, LooksCloselyAtFewTrianglesOfASmoothSurface)
{
  // A grid on a sphere, seen from points near its centre, where everything is nearly as near.
  Soup ball;
  constexpr int kRows = 60, kColumns = 120;
  for (int i = 0; i <= kRows; ++i)
  {
    for (int j = 0; j < kColumns; ++j)
    {
      const double a = M_PI * i / kRows, b = 2.0 * M_PI * j / kColumns;
      ball.x.emplace_back(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      const Index here = i * kColumns + j, right = i * kColumns + (j + 1) % kColumns;
      if (i < kRows)
      {
        ball.triangles.push_back({here, here + kColumns, right});
        ball.triangles.push_back({right, here + kColumns, right + kColumns});
      }
    }
  }
  TriangleTree tree;
  tree.build(ball.triangles, ball.x);
  RandomGeometry random(3);
  int evaluations = 0;
  for (int i = 0; i < 300; ++i)
  {
    const Vec3 p = random.point(0.3);
    const TriangleTree::Nearest found = tree.nearest(p, ball.x);
    EXPECT_EQ(found.triangle, bruteForce(ball, p).triangle);
    evaluations += tree.nearest(p, ball.x, found.triangle).evaluations;
  }
  EXPECT_LT(evaluations, 300 * 0.01 * ball.triangles.size());
}

TEST(TriangleTree, HasNoAnswerWhereNothingIsFinite)
{
  TriangleTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.nearest(Vec3::Zero(), {}).triangle, -1);
  RandomGeometry random(4);
  Soup soup = randomSoup(random, 20, 0.1);
  tree.build(soup.triangles, soup.x);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(tree.nearest(Vec3(0.0, nan, 0.0), soup.x).triangle, -1);
  soup.x[4].y() = nan;
  EXPECT_THROW(TriangleTree().build(soup.triangles, soup.x), Error);
  soup.x.assign(soup.x.size(), Vec3::Constant(nan));
  tree.refit(soup.x);
  EXPECT_EQ(tree.nearest(Vec3::Zero(), soup.x).triangle, -1);
}

// The tree may be where the surface was, and some triangles may not count.
TEST(TriangleTree, FindsTheNearestOfThoseAllowedOnASurfaceThatMovedOn)
{
  RandomGeometry random(17);
  for (const double moved : {0.0, 1e-3, 0.3})
  {
    Soup soup = randomSoup(random, 150, 0.1);
    TriangleTree tree;
    tree.build(soup.triangles, soup.x);
    for (Vec3& p : soup.x)
    {
      p += moved * random.point(1.0).normalized();
    }
    for (int i = 0; i < 200; ++i)
    {
      const Vec3 p = random.point(1.2);
      const auto allowed = [i](Index triangle) { return (triangle + i) % 3 != 0; };
      const TriangleTree::Nearest exact = bruteForce(soup, p, allowed);
      for (const Index hint : {-1, i % static_cast<Index>(soup.triangles.size())})
      {
        const TriangleTree::Nearest found =
            tree.nearestOf(p, soup.x, hint, {Vec3::Zero(), moved}, allowed);
        EXPECT_EQ(found.triangle, exact.triangle);
        EXPECT_EQ(found.point.squared_distance, exact.point.squared_distance);
      }
    }
    const auto none = [](Index) { return false; };
    EXPECT_EQ(tree.nearestOf(Vec3::Zero(), soup.x, 0, {Vec3::Zero(), moved}, none).triangle, -1);
  }
}

/** Of the soup, how far all triangles are from p, in order. */
std::vector<double> distances(const Soup& soup, const Vec3& p)
{
  std::vector<double> all;
  for (const Triangle& t : soup.triangles)
  {
    all.push_back(
        std::sqrt(closestOnTriangle(p, soup.x[t[0]], soup.x[t[1]], soup.x[t[2]]).squared_distance));
  }
  std::sort(all.begin(), all.end());
  return all;
}

// However the surface moved since, the list has all that is nearer than its radius, and nothing
// else.
TEST(TriangleTree, ListsAllThatIsNearerThanTheListsRadius)
{
  RandomGeometry random(23);
  bool full = false, whole = false;
  for (const double moved : {0.0, 0.05})
  {
    Soup soup = randomSoup(random, 300, 0.1);
    TriangleTree tree;
    tree.build(soup.triangles, soup.x);
    const Vec3 shift(0.3, -0.2, 0.7);
    for (Vec3& p : soup.x)
    {
      p += shift + moved * random.point(1.0).normalized();
    }
    for (int i = 0; i < 200; ++i)
    {
      const Vec3 p = random.point(1.2);
      const double slack = i % 3 == 0 ? 0.01 : 0.2;
      Shortlist list;
      const TriangleTree::Nearest found =
          tree.shortlist(p, soup.x, i % 2 == 0 ? -1 : i, {shift, moved}, slack, list);
      EXPECT_EQ(found.triangle, bruteForce(soup, p).triangle);
      const std::vector<double> all = distances(soup, p);
      const double wanted = all[0] + slack;
      const auto nearer = [&](double radius) {
        return static_cast<int>(std::lower_bound(all.begin(), all.end(), radius) - all.begin());
      };
      EXPECT_LE(list.radius(), wanted);
      EXPECT_EQ(list.size(), nearer(list.radius()));
      for (int k = 0; k < list.size(); ++k)
      {
        const Triangle& t = soup.triangles[list[k]];
        EXPECT_EQ(
            std::sqrt(
                closestOnTriangle(p, soup.x[t[0]], soup.x[t[1]], soup.x[t[2]]).squared_distance),
            all[k]);
      }
      if (nearer(wanted) > Shortlist::kMost)
      {
        full = true;
        EXPECT_EQ(list.radius(), all[Shortlist::kMost]);
      }
      else
      {
        whole = true;
        EXPECT_EQ(list.radius(), wanted);
      }
    }
  }
  EXPECT_TRUE(full && whole);
}

}  // namespace
}  // namespace soft_tissue
