/** Clips segments against tets, four pairs side by side; compiled once per instruction set into
 * SOFT_TISSUE_KERNELS. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "soft_tissue_sim/collision/clip_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
namespace
{
constexpr int kLanes = 4;
typedef double Four __attribute__((vector_size(32)));
typedef std::int64_t Masks __attribute__((vector_size(32)));

/** As tetCoordinates() has it. */
constexpr double kFlat = 1e-12;
/** As clipSegment() has it. */
constexpr double kTouching = 1e-12;

Four all(double value)
{
  return Four{} + value;
}
Four lesser(const Four& a, const Four& b)
{
  return a < b ? a : b;
}
Four greater(const Four& a, const Four& b)
{
  return a > b ? a : b;
}
Four magnitude(const Four& v)
{
  return greater(v, -v);
}

Four root(const Four& v)
{
#if defined(__AVX__)
  return _mm256_sqrt_pd(v);
#else
  return Four{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

bool allOf(const Masks& masks)
{
#if defined(__AVX__)
  return _mm256_movemask_pd(reinterpret_cast<const __m256d&>(masks)) == 0xf;
#else
  return (masks[0] & masks[1] & masks[2] & masks[3]) != 0;
#endif
}

/** A point of each pair. */
struct Point
{
  Four x, y, z;
};

Point operator-(const Point& a, const Point& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Point operator+(const Point& a, const Point& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Point cross(const Point& a, const Point& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Four dot(const Point& a, const Point& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Point load(const Vec3* const (&p)[kLanes])
{
  typedef double Two __attribute__((vector_size(16)));
  Two xy[kLanes];
  for (int lane = 0; lane < kLanes; ++lane)
  {
    std::memcpy(&xy[lane], p[lane]->data(), sizeof(Two));
  }
  const Four even = __builtin_shufflevector(xy[0], xy[2], 0, 1, 2, 3);
  const Four odd = __builtin_shufflevector(xy[1], xy[3], 0, 1, 2, 3);
  return {__builtin_shufflevector(even, odd, 0, 4, 2, 6),
          __builtin_shufflevector(even, odd, 1, 5, 3, 7),
          Four{(*p[0])[2], (*p[1])[2], (*p[2])[2], (*p[3])[2]}};
}

/** Node `k` of an element of each pair. */
template <typename ElementOf>
Point nodes(const ElementSet& set, const Vec3* x, int k, const ElementOf& elementOf)
{
  const Vec3* p[kLanes];
  for (int lane = 0; lane < kLanes; ++lane)
  {
    p[lane] = x + set.nodes[static_cast<std::size_t>(elementOf(lane)) * set.nodes_each + k];
  }
  return load(p);
}

/** Barycentric coordinates, as TetCoordinates has them. */
struct Tets
{
  Masks flat;
  Point centre;
  Point normal[4];  ///< of the faces, as long as they are large
  Four per_volume6;

  Tets(const Point& a, const Point& b, const Point& c, const Point& d)
  {
    const Point ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
    normal[0] = cross(bd, bc);
    normal[1] = cross(ac, ad);
    normal[2] = cross(ad, ab);
    normal[3] = cross(ab, ac);
    const Four volume6 = dot(normal[3], ad);
    const Four squared =
        greater(greater(greater(dot(ab, ab), dot(ac, ac)), greater(dot(ad, ad), dot(bc, bc))),
                greater(dot(bd, bd), dot(cd, cd)));
    const Four longest = root(squared);
    // What is no number is not above anything; what is infinite is still so less itself.
    const Masks thick = magnitude(volume6) > kFlat * longest * longest * longest;
    flat = ~(thick & (volume6 - volume6 == 0.0));
    const Point sum = a + b + c + d;
    centre = {0.25 * sum.x, 0.25 * sum.y, 0.25 * sum.z};
    per_volume6 = 1.0 / volume6;
  }

  /** Of corner `k`, at a point less the centre; 0 where it all but is. */
  Four weight(int k, const Point& p) const
  {
    const Four w = dot(normal[k], p) * per_volume6 + 0.25;
    return magnitude(w) <= kTouching ? Four{} : w;
  }
};

Index clip(const ElementSet& segments, const Vec3* x_segments, const ElementSet& tets,
           const Vec3* x_tets, const ElementPair* pairs, Index count, ClippedPair* pieces)
{
  ClippedPair* next = pieces;
  const int last_node = segments.nodes_each - 1;
  for (Index first = 0; first < count; first += kLanes)
  {
    const int used = std::min<Index>(kLanes, count - first);
    const auto pairOf = [&](int lane) { return pairs[first + std::min(lane, used - 1)]; };
    const auto segmentOf = [&](int lane) { return pairOf(lane).first; };
    const auto tetOf = [&](int lane) { return pairOf(lane).second; };
    const Tets in(nodes(tets, x_tets, 0, tetOf), nodes(tets, x_tets, 1, tetOf),
                  nodes(tets, x_tets, 2, tetOf), nodes(tets, x_tets, 3, tetOf));
    const Point a = nodes(segments, x_segments, 0, segmentOf) - in.centre;
    const Point b = nodes(segments, x_segments, last_node, segmentOf) - in.centre;
    Four at_a[4], at_b[4];
    Masks missed = in.flat;
    for (int k = 0; k < 4; ++k)
    {
      at_a[k] = in.weight(k, a);
      at_b[k] = in.weight(k, b);
      missed |= (at_a[k] < 0.0) & (at_b[k] < 0.0);
    }
    if (allOf(missed))
    {
      continue;
    }
    Four begin = {}, end = all(1.0);
    for (int k = 0; k < 4; ++k)
    {
      const Four zero = at_a[k] / (at_a[k] - at_b[k]);
      const Masks a_out = at_a[k] < 0.0, b_out = at_b[k] < 0.0;
      begin = a_out ? greater(begin, zero) : begin;
      end = b_out & ~a_out ? lesser(end, zero) : end;
    }
    const Masks inside = (begin < end) & ~missed;
    for (int lane = 0; lane < used; ++lane)
    {
      *next = {pairOf(lane), {begin[lane], end[lane]}};
      next += inside[lane] != 0 ? 1 : 0;
    }
  }
  return static_cast<Index>(next - pieces);
}
}  // namespace

ClipPairs clipLoop()
{
  return clip;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
