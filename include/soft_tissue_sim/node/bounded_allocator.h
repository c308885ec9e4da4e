#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>

namespace soft_tissue_sim
{
/**
 * Allocator for messages from outside that refuses arrays of more than 256 MB.
 *
 * roscpp makes an array as long as four bytes of the message claim before it looks whether the
 * message goes on so far: one flipped bit takes all memory. `geometry_msgs::Polygon_<
 * BoundedAllocator<void>>` has the same type and sum as `geometry_msgs::Polygon`; roscpp logs what
 * is thrown here, and drops the message.
 */
template <typename T>
class BoundedAllocator
{
 public:
  using value_type = T;
  template <typename U>
  struct rebind
  {
    using other = BoundedAllocator<U>;
  };

  BoundedAllocator() = default;
  template <typename U>
  BoundedAllocator(const BoundedAllocator<U>&)  // NOLINT: containers convert
  {}

  /** @throws std::length_error for more than 256 MB, std::bad_alloc */
  T* allocate(std::size_t count)
  {
    constexpr std::size_t kMostBytes = std::size_t{256} << 20;
    if (count > kMostBytes / sizeof(T))
    {
      throw std::length_error("the message claims an array of more than 256 MB");
    }
    return static_cast<T*>(::operator new(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory); }

  template <typename U>
  bool operator==(const BoundedAllocator<U>&) const
  {
    return true;
  }
  template <typename U>
  bool operator!=(const BoundedAllocator<U>&) const
  {
    return false;
  }
};

}  // namespace soft_tissue_sim
