#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/pair_bodies.h"

namespace
{
std::atomic<long> allocation_count{0};
}

void* operator new(std::size_t size)
{
  ++allocation_count;
  if (void* memory = std::malloc(size > 0 ? size : 1))
  {
    return memory;
  }
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}

namespace soft_tissue::test
{
namespace
{
// Positions go to and fro, far enough for boxes to be renewed.
TEST(PairAllocation, SteadyCallsTakeNoMemory)
{
  const PairBody a(makeBall(1.0, 1500)), b(makeBall(1.0, 1500));
  RandomGeometry random(1);
  const Points near = b.moved(Vec3(1.6, 0.0, 0.0)), far = b.moved(Vec3(5.0, 0.0, 0.0));
  const Points shaken = PairBody::shaken(near, random, 0.1);
  const Points nearer = b.moved(Vec3(1.597, 0.0, 0.0)), nearest = b.moved(Vec3(1.56, 0.0, 0.0));
  for (const PairMethod method : {PairMethod::tree, PairMethod::hash, PairMethod::sweep})
  {
    for (const bool one_body : {false, true})
    {
      const auto finder = makePairFinder(method, a.edges(), b.tets(), one_body);
      std::vector<ElementPair> pairs;
      const auto callAll = [&] {
        for (const Points* x :
             {&near, &nearer, &nearest, &nearer, &near, &nearer, &shaken, &far, &near})
        {
          finder->find(one_body ? x->data() : a.x.data(), x->data(), 0.01, pairs);
        }
      };
      callAll();
      callAll();  // how fast it goes is known by now
      const long before = allocation_count;
      callAll();
      EXPECT_EQ(allocation_count, before);
      EXPECT_FALSE(pairs.empty());
    }
  }
  const long before = allocation_count;
  ::operator delete(::operator new(1));
  EXPECT_GT(allocation_count, before);  // the counter does count
}

}  // namespace
}  // namespace soft_tissue::test
