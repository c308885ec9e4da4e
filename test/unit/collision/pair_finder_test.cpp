#include "soft_tissue_sim/collision/pair_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/parallel.h"
#include "support/pair_bodies.h"

namespace soft_tissue::test
{
namespace
{
class PairFinders : public testing::TestWithParam<PairMethod>
{
 protected:
  /** Sets out to find pairs of these; positions of both bodies may be moved between calls. */
  void prepare(const PairBody& a, const PairBody& b, bool one_body = false)
  {
    first_ = a.edges();
    second_ = b.tets();
    one_body_ = one_body;
    finder_ = makePairFinder(GetParam(), first_, second_, one_body);
  }
  /** @return how many there are */
  std::size_t expectAllFound(const Points& x_first, const Points& x_second, double margin = 0.0)
  {
    finder_->find(x_first.data(), x_second.data(), margin, pairs_);
    const SortedPairs truth =
        bruteForcePairs(first_, second_, x_first, x_second, margin, one_body_);
    EXPECT_EQ(sortedPairs(pairs_), truth);
    return truth.size();
  }

  ElementSet first_, second_;
  bool one_body_ = false;
  std::unique_ptr<PairFinder> finder_;
  std::vector<ElementPair> pairs_ = {{7, 7}};  // what was in it is gone
};
}  // namespace

TEST_P(PairFinders, FindAllOfTwoBallsThatMove)
{
  const PairBody a(makeBall(1.0, 2000)), b(makeBall(0.8, 1500));
  prepare(a, b);
  RandomGeometry random(1);
  Points x_b;
  for (const double apart : {1.9, 1.75, 1.6, 1.0, 0.0, 1.5, 50.0, 1.7, -1.7, 1e6, 1.7})
  {
    x_b = b.moved(Vec3(apart, 0.1, -0.05));
    const std::size_t found = expectAllFound(a.x, x_b);
    EXPECT_EQ(found > 0, std::abs(apart) < 1.76) << apart;
    expectAllFound(a.x, b.shaken(x_b, random, 0.01));
    expectAllFound(a.shaken(a.x, random, 0.1), b.shaken(x_b, random, 0.1));
    expectAllFound(a.x, x_b, 0.05);
  }
}

TEST_P(PairFinders, FindAllOfDeformedBodies)
{
  const PairBody a(makeBox({6, 5, 4}, {0.06, 0.05, 0.04}));
  const PairBody b(makeBox({7, 3, 3}, {0.09, 0.03, 0.03}));
  prepare(a, b);
  for (int step = 0; step <= 12; ++step)
  {
    const double angle = 0.3 * step;
    Points x_a = a.x, x_b = b.x;
    for (Vec3& p : x_a)
    {
      p.z() *= 1.0 - 0.07 * step;  // flatter and flatter
    }
    for (Vec3& p : x_b)
    {
      const double turn = angle * p.x() / 0.09;  // twisted
      p = Eigen::AngleAxisd(turn, Vec3::UnitX()) * p + Vec3(0.01, 0.02, 0.001 * step);
    }
    EXPECT_GT(expectAllFound(x_a, x_b), 0u);
  }
}

TEST_P(PairFinders, FindAllWithinMargins)
{
  const PairBody a(makeBox({3, 3, 3}, Vec3::Ones())), b(makeBox({4, 4, 4}, Vec3::Ones()));
  prepare(a, b);
  const Points x_b = b.moved(Vec3(1.25, 0.5, 0.0));
  EXPECT_EQ(expectAllFound(a.x, x_b, 0.0), 0u);
  EXPECT_EQ(expectAllFound(a.x, x_b, 0.2499), 0u);
  const std::size_t at_the_side = expectAllFound(a.x, x_b, 0.25);  // as far as they are apart
  EXPECT_GT(at_the_side, 0u);
  EXPECT_GT(expectAllFound(a.x, x_b, 0.6), at_the_side);
  EXPECT_EQ(expectAllFound(a.x, x_b, 10.0), std::size_t(first_.count) * second_.count);
}

TEST_P(PairFinders, LeaveOutWhatSharesNodesInOneBody)
{
  const PairBody body(makeTube(0.3, 0.5, 1.0, 800));
  prepare(body, body, true);
  EXPECT_GT(expectAllFound(body.x, body.x), 0u);
  RandomGeometry random(3);
  expectAllFound(body.shaken(body.x, random, 0.05), body.x);
  Points folded = body.x;
  for (Vec3& p : folded)
  {
    p.z() = std::abs(p.z() - 0.5);
  }
  expectAllFound(folded, folded);
  expectAllFound(folded, folded, 0.02);
  prepare(body, body, false);  // the same numbers, but of two bodies
  expectAllFound(body.x, folded);
}

// Steps of a tenth of an edge and less: pairs are kept from call to call. Bodies come nearer, pass
// each other, stand still and leap; the margin is not the same each time.
TEST_P(PairFinders, FindAllOfWhatMovesSlowly)
{
  const PairBody a(makeBall(1.0, 1500)), b(makeBall(1.0, 1500));
  prepare(a, b);
  RandomGeometry random(6);
  for (const double step : {0.02, 0.002, 0.0, 0.06, 0.3})
  {
    Points x_a = a.x, x_b = b.moved(Vec3(1.9, 0.1, 0.0));
    std::size_t found = 0;
    for (int call = 0; call < 24; ++call)
    {
      for (Vec3& p : x_b)
      {
        p += step * Vec3(-0.5, 0.1, 0.0);
      }
      x_a = PairBody::shaken(x_a, random, 0.3 * step);
      x_b = PairBody::shaken(x_b, random, 0.3 * step);
      found += expectAllFound(x_a, x_b, call % 5 == 4 ? 0.02 : call % 7 == 6 ? 0.05 : 0.0);
      ASSERT_FALSE(HasFailure()) << step << " " << call;
    }
    EXPECT_GT(found, 0u);
  }
}

TEST_P(PairFinders, FindAllOfOneBodyThatMovesSlowly)
{
  const PairBody body(makeTube(0.3, 0.5, 1.0, 800));
  prepare(body, body, true);
  for (int call = 0; call < 20; ++call)
  {
    Points x = body.x;
    for (Vec3& p : x)
    {
      p.z() = std::abs(p.z() - 0.5) + 0.003 * call * p.x();
    }
    expectAllFound(x, x, 0.01);
  }
}

TEST_P(PairFinders, TakeElementsOfOneToFourNodes)
{
  RandomGeometry random(4);
  Points x(60), y(90);
  std::vector<Index> nodes(240);
  for (Vec3& p : x)
  {
    p = random.point(1.0);
  }
  for (Vec3& p : y)
  {
    p = random.point(1.0);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    nodes[i] = static_cast<Index>(random.uniform(0.0, 60.0));
  }
  for (int first_nodes = 1; first_nodes <= 4; ++first_nodes)
  {
    for (int second_nodes = 1; second_nodes <= 4; ++second_nodes)
    {
      for (const bool one_body : {false, true})
      {
        first_ = {nodes.data(), first_nodes, 50};
        second_ = {nodes.data() + 3, second_nodes, 59};
        one_body_ = one_body;
        finder_ = makePairFinder(GetParam(), first_, second_, one_body);
        expectAllFound(x, one_body ? x : y);
        expectAllFound(x, one_body ? x : y, 0.1);
      }
    }
  }
}

TEST_P(PairFinders, TakeCoincidentFlatAndEmpty)
{
  const PairBody a(makeBox({3, 3, 3}, Vec3::Ones())), b(makeBox({2, 3, 2}, Vec3::Ones()));
  prepare(a, b);
  const std::size_t all = std::size_t(first_.count) * second_.count;
  const Points at_a(a.x.size(), Vec3(1, 2, 3)), at_b(b.x.size(), Vec3(1, 2, 3));
  EXPECT_EQ(expectAllFound(at_a, at_b), all);  // all in one point, at the first call
  EXPECT_GT(expectAllFound(a.x, b.x), 0u);
  EXPECT_EQ(expectAllFound(at_a, at_b), all);
  Points flat_a = a.x, flat_b = b.x;
  for (Vec3& p : flat_a)
  {
    p.z() = 0.5;
  }
  EXPECT_GT(expectAllFound(flat_a, b.x), 0u);
  for (Vec3& p : flat_b)
  {
    p.z() = std::nextafter(0.5, 1.0);
  }
  EXPECT_EQ(expectAllFound(flat_a, flat_b), 0u);
  EXPECT_GT(expectAllFound(flat_a, flat_b, 1e-12), 0u);

  const ElementSet none;
  for (const auto& sets :
       {std::make_pair(none, second_), std::make_pair(first_, none), std::make_pair(none, none)})
  {
    finder_ = makePairFinder(GetParam(), sets.first, sets.second, false);
    finder_->find(a.x.data(), b.x.data(), 1.0, pairs_);
    EXPECT_TRUE(pairs_.empty());
  }
}

TEST_P(PairFinders, LeaveOutNodesThatAreNoNumbers)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const PairBody a(makeBall(1.0, 600)), b(makeBall(1.0, 600));
  for (const bool bad_at_first : {false, true})
  {
    prepare(a, b);
    const Points x_b = b.moved(Vec3(0.7, 0.0, 0.1));
    std::size_t all = 0;
    for (const double bad : {std::nan(""), infinity, -infinity})
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        if (!bad_at_first || all > 0)
        {
          all = expectAllFound(a.x, x_b);
        }
        Points broken_a = a.x, broken_b = x_b;
        for (std::size_t i = axis; i < broken_a.size(); i += 17)
        {
          broken_a[i][axis] = bad;
        }
        broken_b[5 + axis][axis] = bad;
        const std::size_t left = expectAllFound(broken_a, broken_b);
        EXPECT_GT(left, 0u);
        EXPECT_TRUE(all == 0 || left < all);
        EXPECT_EQ(expectAllFound(a.x, Points(b.x.size(), Vec3::Constant(bad))), 0u);
        all = expectAllFound(a.x, x_b);
      }
    }
  }
}

TEST_P(PairFinders, LeaveOutPairsThatAreSaidToBeNone)
{
  const PairBody a(makeBall(1.0, 600)), b(makeBall(1.0, 600));
  prepare(a, b);
  const auto never = [](const ElementPair& pair) { return (pair.first + pair.second) % 3 != 0; };
  finder_->leaveOut(never);
  for (int step = 0; step < 12; ++step)  // slowly: later calls pick from what was kept
  {
    const Points x_b = b.moved(Vec3(0.7 + (step < 8 ? 0.0005 * step : 0.1 * step), 0.0, 0.1));
    finder_->find(a.x.data(), x_b.data(), 0.02, pairs_);
    SortedPairs truth = bruteForcePairs(first_, second_, a.x, x_b, 0.02, false);
    const std::size_t all = truth.size();
    truth.erase(std::remove_if(truth.begin(), truth.end(),
                               [&](const auto& pair) {
                                 return never({pair.second, pair.first});
                               }),
                truth.end());
    EXPECT_EQ(sortedPairs(pairs_), truth);
    EXPECT_GT(truth.size(), all / 4);
    EXPECT_LT(truth.size(), all / 2);
  }
}

TEST_P(PairFinders, FindAllFarAway)
{
  const PairBody a(makeBall(0.01, 800)), b(makeBall(0.01, 800));
  prepare(a, b);
  for (const double far : {1e6, -1e6, 0.0, 1e9})
  {
    const Vec3 place(far, 2.0 * far, -far);
    EXPECT_GT(expectAllFound(a.moved(place), b.moved(place + Vec3(0.015, 0.0, 0.0))), 0u);
    expectAllFound(a.moved(place), b.moved(place + Vec3(0.0149, 0.001, 0.0)), 1e-3);
    // One stays, the other moves on.
    expectAllFound(a.moved(place), b.moved(place + Vec3(0.1, 0.0, 0.0)));
  }
}

TEST_P(PairFinders, AreTheSameOnAnyNumberOfThreads)
{
  const PairBody a(makeBall(1.0, 1200)), b(makeBall(1.0, 1200));
  prepare(a, b);
  const Points x_b = b.moved(Vec3(1.4, 0.0, 0.0));
  const int before = threadCount();
  for (const int threads : {1, 2})
  {
    setThreadCount(threads);
    EXPECT_GT(expectAllFound(a.x, x_b), 0u);
  }
  setThreadCount(before);
}

INSTANTIATE_TEST_SUITE_P(Methods, PairFinders,
                         testing::Values(PairMethod::tree, PairMethod::hash, PairMethod::sweep),
                         [](const testing::TestParamInfo<PairMethod>& info) {
                           return info.param == PairMethod::tree   ? "tree"
                                  : info.param == PairMethod::hash ? "hash"
                                                                   : "sweep";
                         });

}  // namespace soft_tissue::test
