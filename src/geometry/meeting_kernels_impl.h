/** Whether pairs meet, as single precision sees it; compiled once per instruction set into
 * SOFT_TISSUE_KERNELS. */
#pragma once

#include <cstring>
#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "soft_tissue_sim/geometry/meeting_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
typedef float Eight __attribute__((vector_size(32)));
typedef std::int32_t Masks __attribute__((vector_size(32)));

/** Weights times volume are this exact, in shares of size times size times reach: at most some 450
 * roundings of 2^-24, those of the coordinates among them, counted term by term. */
constexpr float kRounding = 3e-5f;
/** Products of three coordinates below this don't overflow, m. */
constexpr float kMost = 1e10f;
/** What is lost below the least number, m^3. */
constexpr float kLeast = 1e-36f;

inline Eight smaller(const Eight& a, const Eight& b)
{
  return a < b ? a : b;
}
inline Eight larger(const Eight& a, const Eight& b)
{
  return a > b ? a : b;
}
inline Eight all(float value)
{
  return Eight{} + value;
}

struct Point
{
  Eight x, y, z;
};

inline Point load(const float (&p)[3][kMeetingLanes])
{
  Point point;
  std::memcpy(&point.x, p[0], sizeof(Eight));
  std::memcpy(&point.y, p[1], sizeof(Eight));
  std::memcpy(&point.z, p[2], sizeof(Eight));
  return point;
}
/** The same from points side by side. */
inline Point load(const float (&p)[kMeetingLanes][4])
{
  typedef float Four __attribute__((vector_size(16)));
  const auto two = [&](int k) {
    Four low, high;
    std::memcpy(&low, p[k], sizeof(low));
    std::memcpy(&high, p[k + 4], sizeof(high));
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  const Eight a = two(0), b = two(1), c = two(2), d = two(3);
  const Eight ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight ab_z = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Eight cd_z = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  return {__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(ab_z, cd_z, 0, 1, 8, 9, 4, 5, 12, 13)};
}
inline Point operator-(const Point& a, const Point& b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point operator+(const Point& a, const Point& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Point operator*(const Eight& s, const Point& p)
{
  return {s * p.x, s * p.y, s * p.z};
}
inline Eight dot(const Point& a, const Point& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point cross(const Point& a, const Point& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/** The largest coordinate so far, m; not below kMost if one is no number. */
class Extent
{
 public:
  void take(const Point& p)
  {
    take(p.x);
    take(p.y);
    take(p.z);
  }
  Eight value() const { return nothing_ == 0.0f ? largest_ : all(kMost); }

 private:
  void take(const Eight& v)
  {
    largest_ = larger(largest_, larger(v, -v));
    nothing_ += v * 0.0f;
  }

  Eight largest_ = {};
  Eight nothing_ = {};  ///< 0 while all are finite
};

/** Weights of points in a tet with its first corner at the origin, times six of its volumes. */
class Weights
{
 public:
  Weights(const Point& e1, const Point& e2, const Point& e3)
      : n1_(cross(e2, e3)), n2_(cross(e3, e1)), n3_(cross(e1, e2)), volume6_(dot(e1, n1_))
  {
    const Eight sign = volume6_ < 0.0f ? all(-1.0f) : all(1.0f);
    n1_ = sign * n1_;
    n2_ = sign * n2_;
    n3_ = sign * n3_;
    volume6_ = sign * volume6_;
  }

  void of(const Point& p, Eight (&u)[4]) const
  {
    u[1] = dot(n1_, p);
    u[2] = dot(n2_, p);
    u[3] = dot(n3_, p);
    u[0] = volume6_ - (u[1] + u[2] + u[3]);
  }

  /** Of the gradient of weight k times six volumes, which is twice a face's area. */
  Eight squaredNormal(int k) const
  {
    const Point n = k == 0 ? all(-1.0f) * (n1_ + n2_ + n3_) : k == 1 ? n1_ : k == 2 ? n2_ : n3_;
    return dot(n, n);
  }

 private:
  Point n1_, n2_, n3_;
  Eight volume6_;
};

/** Four lines over [0, 1], by their values p at 0 and q at 1: is there a place where all are
 * above zero? Where lines rise, all before `middle` is below what they are there; where they fall,
 * all behind it. */
struct Lines
{
  Eight least;    ///< of all lines at a place where there may be most room: a lower bound
  Eight highest;  ///< an upper bound on the least of them anywhere

  Lines(const Eight (&p)[4], const Eight (&q)[4])
  {
    Eight low = {}, high = all(1.0f), never = all(1e38f);
    for (int k = 0; k < 4; ++k)
    {
      const Eight zero = p[k] / (p[k] - q[k]);
      low = ((p[k] < 0.0f) & (q[k] > 0.0f)) ? larger(low, zero) : low;
      high = ((p[k] > 0.0f) & (q[k] < 0.0f)) ? smaller(high, zero) : high;
      never = smaller(never, larger(p[k], q[k]));
    }
    const Eight middle = 0.5f * (low + high);
    Eight rising = all(1e38f), falling = rising;
    for (int k = 0; k < 4; ++k)
    {
      const Eight value = p[k] + middle * (q[k] - p[k]);
      const Masks rises = q[k] > p[k];
      rising = rises ? smaller(rising, value) : rising;
      falling = rises ? falling : smaller(falling, value);
    }
    least = smaller(rising, falling);
    highest = smaller(never, larger(rising, falling));
  }
};

inline void tell(const Masks& apart, const Masks& together, Meeting* meetings)
{
  const Masks numbers = apart ? Masks{} + static_cast<int>(Meeting::apart)
                              : (together & static_cast<int>(Meeting::together));
  for (int i = 0; i < kMeetingLanes; ++i)
  {
    meetings[i] = static_cast<Meeting>(numbers[i]);
  }
}

inline void tellTets(const TetPairLanes& lanes, Meeting* meetings)
{
  const Point a[4] = {{}, load(lanes.a[0]), load(lanes.a[1]), load(lanes.a[2])};
  Point b[4], a_from_b[4], b_from_b[4];
  Extent size_of_a, size_of_b, extent;
  for (int k = 0; k < 4; ++k)
  {
    b[k] = load(lanes.b[k]);
    a_from_b[k] = a[k] - b[0];
    b_from_b[k] = b[k] - b[0];
    size_of_a.take(a[k]);
    size_of_b.take(b_from_b[k]);
    extent.take(b[k]);
    extent.take(a_from_b[k]);
  }
  Eight u[4][4], v[4];  // u: height over a face of the first tet, of a corner of the second
  Eight most[4];        // the largest weight in the second tet that a corner of the first has
  const Weights in_a(a[1], a[2], a[3]);
  const Weights in_b(b_from_b[1], b_from_b[2], b_from_b[3]);
  for (int k = 0; k < 4; ++k)
  {
    in_a.of(b[k], v);
    for (int i = 0; i < 4; ++i)
    {
      u[i][k] = -v[i];
    }
    in_b.of(a_from_b[k], v);
    for (int i = 0; i < 4; ++i)
    {
      most[i] = k == 0 ? v[i] : larger(most[i], v[i]);
    }
  }
  const Eight reach = larger(extent.value(), larger(size_of_a.value(), size_of_b.value()));
  const Eight tolerance_a = kRounding * size_of_a.value() * size_of_a.value() * reach + kLeast;
  const Eight tolerance_b = kRounding * size_of_b.value() * reach * reach + kLeast;
  Masks apart = {}, together = reach < kMost;
  for (int i = 0; i < 4; ++i)
  {
    const Eight least = smaller(smaller(u[i][0], u[i][1]), smaller(u[i][2], u[i][3]));
    apart |= (least > tolerance_a) | (most[i] < -tolerance_b);
    together &= (least < -tolerance_a) & (most[i] > tolerance_b);
  }
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < i; ++j)
    {
      const Lines lines(u[i], u[j]);
      apart |= lines.least > tolerance_a;
      together &= lines.highest < -tolerance_a;
    }
  }
  // What is no number may look beyond a plane all the same.
  tell(apart & (reach < kMost), together, meetings);
}

inline unsigned bitsOf(const Masks& masks)
{
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(masks)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kMeetingLanes; ++i)
  {
    bits |= masks[i] != 0 ? 1u << i : 0u;
  }
  return bits;
#endif
}

// However corners and ends then move by half of the margin, along the plane's normal as it is now
// they stay apart.
inline unsigned tellSegments(const TetSegmentLanes& lanes, float margin)
{
  const Point corners[3] = {load(lanes.tet[0]), load(lanes.tet[1]), load(lanes.tet[2])};
  const Point ends[2] = {load(lanes.ends[0]), load(lanes.ends[1])};
  Extent size, extent;
  for (const Point& p : corners)
  {
    size.take(p);
  }
  for (const Point& p : ends)
  {
    extent.take(p);
  }
  const Weights weights(corners[0], corners[1], corners[2]);
  Eight p[4], q[4];
  weights.of(ends[0], p);
  weights.of(ends[1], q);
  const Eight reach = larger(size.value(), extent.value());
  const Eight squared_size = size.value() * size.value();
  const Eight tolerance = kRounding * squared_size * (reach + margin) + kLeast;
  Masks apart = {};
  for (int k = 0; k < 4; ++k)
  {
    const Eight out = -larger(p[k], q[k]) - tolerance;
    const Eight least = (1.0f + kRounding) * margin * margin * weights.squaredNormal(k);
    apart |= (out > 0.0f) & (out * out > least);
  }
  return bitsOf(apart & (reach < kMost));
}

const MeetingKernels& meetings()
{
  static const MeetingKernels kernels = {tellTets, tellSegments};
  return kernels;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
