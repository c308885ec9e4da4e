#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/field_meshes.h"
#include "support/field_oracle.h"

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

namespace soft_tissue
{
namespace
{
TEST(FieldAllocation, MarchesTakeNoMemory)
{
  const test::FieldBody body(test::ballMesh(8, 0.05));
  test::RandomGeometry random(1);
  Points shaken = body.mesh.nodes;
  for (Vec3& p : shaken)
  {
    p += random.point(0.005);
  }
  const std::vector<Index> wanted = {0, 50, 100, 200, 300};
  const auto field = body.field();
  const long before = allocation_count;
  field->march(body.mesh.nodes);
  field->marchUntil(shaken, wanted);
  field->march(shaken);
  field->marchUntil(body.mesh.nodes, wanted);
  EXPECT_EQ(allocation_count, before);
  ::operator delete(::operator new(1));
  EXPECT_GT(allocation_count, before);  // the counter does count
}

}  // namespace
}  // namespace soft_tissue
