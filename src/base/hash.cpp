#include "soft_tissue_sim/base/hash.h"

#include <cstring>

namespace soft_tissue
{
namespace
{
constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
constexpr std::size_t kLanes = 4;

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
  std::size_t i = 0;
  if (size >= kLanes * 8)
  {
    // Lanes that don't wait for each other.
    std::uint64_t lanes[kLanes];
    for (std::uint64_t lane = 0; lane < kLanes; ++lane)
    {
      lanes[lane] = state_ + lane * kOdd;
    }
    for (; i + kLanes * 8 <= size; i += kLanes * 8)
    {
      std::uint64_t words[kLanes];
      std::memcpy(words, bytes + i, sizeof(words));
      for (std::uint64_t lane = 0; lane < kLanes; ++lane)
      {
        lanes[lane] = mix(lanes[lane] + words[lane]) + kOdd;
      }
    }
    for (const std::uint64_t lane : lanes)
    {
      state_ = mix(state_ + lane) + kOdd;
    }
  }
  for (; i < size; i += 8)
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, size - i < 8 ? size - i : 8);
    state_ = mix(state_ + word) + kOdd;
  }
}

std::uint64_t StateHash::value() const
{
  return mix(state_);
}

}  // namespace soft_tissue
