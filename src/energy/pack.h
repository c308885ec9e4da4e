/**
 * A few doubles worked on at once, as GCC vectors. Included by kernel files only, inside their own
 * namespace (SOFT_TISSUE_KERNELS, SOFT_TISSUE_LANES): every function here exists once per
 * instruction set.
 */
#pragma once

#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
constexpr int kLanes = SOFT_TISSUE_LANES;

/** For what inner loops call, which is not inlined otherwise once there are many laws: a tenth of
 * their time. */
#define SOFT_TISSUE_INLINE inline __attribute__((always_inline))

typedef double Pack __attribute__((vector_size(8 * SOFT_TISSUE_LANES)));
typedef long long Mask __attribute__((vector_size(8 * SOFT_TISSUE_LANES)));

inline Pack load(const double* p)
{
  Pack v;
  std::memcpy(&v, p, sizeof(Pack));
  return v;
}

inline void store(double* p, Pack v)
{
  std::memcpy(p, &v, sizeof(Pack));
}

inline Pack splat(double a)
{
  return a - Pack{};
}

inline Pack max(Pack a, Pack b)
{
  return a > b ? a : b;
}

inline Pack min(Pack a, Pack b)
{
  return a < b ? a : b;
}

inline Pack abs(Pack a)
{
  return a < 0.0 ? -a : a;
}

inline Pack sqrt(Pack a)
{
#if SOFT_TISSUE_LANES == 8 && defined(__AVX512F__)
  return reinterpret_cast<Pack>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(a)));
#elif SOFT_TISSUE_LANES == 4 && defined(__AVX__)
  return reinterpret_cast<Pack>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a)));
#elif SOFT_TISSUE_LANES == 2 && defined(__SSE2__)
  return reinterpret_cast<Pack>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a)));
#else
  for (int lane = 0; lane < kLanes; ++lane)
  {
    a[lane] = __builtin_sqrt(a[lane]);
  }
  return a;
#endif
}

inline bool any(Mask m)
{
  long long bits = 0;
  for (int lane = 0; lane < kLanes; ++lane)
  {
    bits |= m[lane];
  }
  return bits != 0;
}

/** Natural logarithm of positive finite numbers, to about one unit in the last place. */
inline Pack log(Pack a)
{
  // a = m 2^e with m in [1/sqrt(2), sqrt(2)); log m = 2 atanh(s), s = (m - 1) / (m + 1), by its
  // series.
  Mask bits = reinterpret_cast<Mask>(a);
  Mask exponent = ((bits >> 52) & 0x7ff) - 1023;
  bits = (bits & 0x000fffffffffffffLL) | 0x3ff0000000000000LL;
  Pack m = reinterpret_cast<Pack>(bits);
  const Mask large = m > 1.4142135623730951;
  m = large ? 0.5 * m : m;
  exponent -= large;
  Pack e;
  for (int lane = 0; lane < kLanes; ++lane)
  {
    e[lane] = static_cast<double>(exponent[lane]);
  }
  const Pack s = (m - 1.0) / (m + 1.0);
  const Pack z = s * s;
  Pack sum = splat(1.0 / 23.0);
  for (int k = 21; k >= 1; k -= 2)
  {
    sum = sum * z + 1.0 / k;
  }
  return e * 0.6931471805599453 + 2.0 * s * sum;
}

/** e^a - 1 of numbers in [-700, 700], to a few units in the last place of it or of e^a. */
inline Pack expMinusOne(Pack a)
{
  // a = k log 2 + r with |r| <= log(2) / 2: e^a - 1 = 2^k (e^r - 1) + (2^k - 1).
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: what is added to it gets whole
  const Pack rounded = a * 1.4426950408889634 + kRound;
  const Pack k = rounded - kRound;
  const Pack r = (a - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;
  Pack sum = splat(1.0);
  for (int n = 14; n >= 2; --n)
  {
    sum = 1.0 + r * (1.0 / n) * sum;
  }
  const Mask exponent =
      reinterpret_cast<Mask>(rounded) - reinterpret_cast<Mask>(splat(kRound)) + 1023;
  const Pack power = reinterpret_cast<Pack>(exponent << 52);
  return power * (r * sum) + (power - 1.0);
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
