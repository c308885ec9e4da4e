#include "soft_tissue_sim/base/hash.h"

#include <cstring>

namespace soft_tissue
{
namespace
{
std::uint64_t mix(std::uint64_t x)
{
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  x ^= x >> 32;
  return x;
}
}  // namespace

void StateHash::add(const void* data, std::size_t size)
{
  const unsigned char* bytes = static_cast<const unsigned char*>(data);
  state_ = mix(state_ ^ static_cast<std::uint64_t>(size));
  for (std::size_t i = 0; i < size; i += 8)
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, size - i < 8 ? size - i : 8);
    state_ = mix(state_ + word) + 0x9e3779b97f4a7c15ULL;
  }
}

std::uint64_t StateHash::value() const
{
  return mix(state_);
}

}  // namespace soft_tissue
