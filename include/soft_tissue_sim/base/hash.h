#pragma once

#include <cstddef>
#include <cstdint>

namespace soft_tissue
{
/** 64-bit hash of a stream of bytes: equal states give equal values, on any machine of one
 * endianness. */
class StateHash
{
 public:
  /** Mixes `size` bytes at `data` into the hash. */
  void add(const void* data, std::size_t size);

  /** Mixes one trivially copyable value into the hash. */
  template <typename T>
  void addValue(const T& value)
  {
    add(&value, sizeof(T));
  }

  /** The hash of all that was added so far. */
  std::uint64_t value() const;

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15ULL;
};

}  // namespace soft_tissue
