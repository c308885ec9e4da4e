/** Loops over nodes and boxes; compiled once per instruction set into SOFT_TISSUE_KERNELS. */
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "box_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** A point, and a number that does not count. */
typedef double Four __attribute__((vector_size(32)));

inline Four load(const Vec3& p)
{
  return Four{p[0], p[1], p[2], 0.0};
}

/** The same where there is a readable number behind the point. */
inline Four loadWide(const Vec3& p)
{
  Four v;
  std::memcpy(&v, p.data(), sizeof(v));
  return v;
}

inline Four lesser(const Four& a, const Four& b)
{
#if defined(__AVX__)
  return _mm256_min_pd(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Four greater(const Four& a, const Four& b)
{
#if defined(__AVX__)
  return _mm256_max_pd(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Vec3 pointOf(const Four& p)
{
  return {p[0], p[1], p[2]};
}

/** What NodeExtremes has, while nodes are taken in. */
struct Extremes
{
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Four low = Four{} + kInfinity, high = -low, least = low, most = high;
  Four nothing = {};  ///< of what is finite

  void take(const Four& p)
  {
    nothing += p * 0.0;
    low = lesser(p, low);
    high = greater(p, high);
  }
  void takeMove(const Four& move)
  {
    least = lesser(move, least);
    most = greater(move, most);
  }
};

/** The nodes ascend: behind each but the last there is another one, so that four numbers can be
 * read. */
inline NodeExtremes extremes(const Vec3* x, const Index* nodes, const Vec3* before, Index count)
{
  Extremes all;
  const Index last = count - 1;
  for (Index i = 0; i < last; ++i)
  {
    const Four p = loadWide(x[nodes[i]]);
    all.take(p);
    if (before != nullptr)
    {
      all.takeMove(p - loadWide(before[i]));
    }
  }
  if (count > 0)
  {
    const Four p = load(x[nodes[last]]);
    all.take(p);
    if (before != nullptr)
    {
      all.takeMove(p - load(before[last]));
    }
  }
  const Four& nothing = all.nothing;
  return {pointOf(all.low), pointOf(all.high), pointOf(all.least), pointOf(all.most),
          nothing[0] + nothing[1] + nothing[2] == 0.0};
}

/** Low and high of an element's nodes. */
struct Span
{
  Four low, high;

  Span(const ElementSet& set, Index element, const Vec3* x)
  {
    const Index* const nodes = set.nodes + static_cast<std::size_t>(element) * set.nodes_each;
    low = high = load(x[nodes[0]]);
    for (int k = 1; k < set.nodes_each; ++k)
    {
      const Four p = load(x[nodes[k]]);
      low = lesser(p, low);
      high = greater(p, high);
    }
  }
};

inline void boxes(const ElementSet& set, const Vec3* x, double margin, const Index* elements,
                  Index count, BoxEnds* boxes)
{
  for (Index i = 0; i < count; ++i)
  {
    const Span span(set, elements[i], x);
    const Four low = span.low - margin, high = -span.high - margin;
    boxes[i] = {{low[0], low[1], low[2], high[0], high[1], high[2]}};
  }
}

/** The ends of a box, in halves that share two. */
struct Halves
{
  Four front, back;

  explicit Halves(const BoxEnds& ends)
  {
    std::memcpy(&front, ends.v, sizeof(front));
    std::memcpy(&back, ends.v + 2, sizeof(back));
  }
};

inline bool isAnyAboveZero(const Four& v)
{
#if defined(__AVX__)
  return _mm256_movemask_pd(_mm256_cmp_pd(v, _mm256_setzero_pd(), _CMP_GT_OQ)) != 0;
#else
  return v[0] > 0.0 || v[1] > 0.0 || v[2] > 0.0 || v[3] > 0.0;
#endif
}

inline Index pick(const BoxedPair* pairs, Index count, const BoxEnds* boxes, const ElementSet& set,
                  const Vec3* x, ElementPair* near)
{
  ElementPair* next = near;
  for (Index i = 0; i < count;)
  {
    const Index second = pairs[i].pair.second;
    const Span span(set, second, x);
    const Halves own(BoxEnds{
        {-span.high[0], -span.high[1], -span.high[2], span.low[0], span.low[1], span.low[2]}});
    for (; i < count && pairs[i].pair.second == second; ++i)
    {
      const Halves other(boxes[pairs[i].box]);
      *next = pairs[i].pair;
      next += isAnyAboveZero(greater(own.front + other.front, own.back + other.back)) ? 0 : 1;
    }
  }
  return static_cast<Index>(next - near);
}

const BoxKernels& boxLoops()
{
  static const BoxKernels loops = {extremes, boxes, pick};
  return loops;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
