/** Passes of conjugate gradients; compiled once per instruction set into SOFT_TISSUE_KERNELS. */
#pragma once

#include <cstring>

#include "soft_tissue_sim/solver/pcg_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
template <typename Real>
struct Wide;
template <>
struct Wide<float>
{
  typedef float Four __attribute__((vector_size(16)));
  typedef float Pack __attribute__((vector_size(32)));
};
template <>
struct Wide<double>
{
  typedef double Four __attribute__((vector_size(32)));
  typedef double Pack __attribute__((vector_size(32)));
};

template <typename Vector, typename Real>
inline Vector loadAs(const Real* p)
{
  Vector v;
  std::memcpy(&v, p, sizeof(Vector));
  return v;
}

template <typename Vector, typename Real>
inline void storeTo(Real* p, const Vector& v)
{
  std::memcpy(p, &v, sizeof(Vector));
}

/** Puts three numbers of a node, and a fourth over the next one's first, whose turn comes. */
template <typename Real>
struct StoreWide
{
  void operator()(Real* p, const typename Wide<Real>::Four& v) const { storeTo(p, v); }
};

/** Puts three numbers: behind the last node is what others write. */
template <typename Real>
struct StoreLast
{
  void operator()(Real* p, const typename Wide<Real>::Four& v) const
  {
    p[0] = v[0];
    p[1] = v[1];
    p[2] = v[2];
  }
};

/** Calls work(node, store) for nodes begin ... end - 1, with one of the two above. */
template <typename Real, typename Work>
inline void forNodes(Index begin, Index end, const Work& work)
{
  for (Index node = begin; node + 1 < end; ++node)
  {
    work(node, StoreWide<Real>());
  }
  if (begin < end)
  {
    work(end - 1, StoreLast<Real>());
  }
}

/** a x b, whatever the fourth numbers are. */
template <typename Four>
inline Four cross(const Four& a, const Four& b)
{
  return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(b, b, 2, 0, 1, 3) -
         __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 0, 3);
}

/** Calls wide(i) for whole packs of the flat range of nodes, and narrow(i) for what is left. */
template <typename Real, typename OnPack, typename OnNumber>
inline void forFlat(Index begin, Index end, const OnPack& wide, const OnNumber& narrow)
{
  constexpr long kSize = sizeof(typename Wide<Real>::Pack) / sizeof(Real);
  long i = 3 * static_cast<long>(begin);
  const long last = 3 * static_cast<long>(end);
  for (; i + kSize <= last; i += kSize)
  {
    wide(i);
  }
  for (; i < last; ++i)
  {
    narrow(i);
  }
}

template <typename Real>
inline double total(const typename Wide<Real>::Pack& sum)
{
  double all = 0.0;
  for (unsigned lane = 0; lane < sizeof(sum) / sizeof(Real); ++lane)
  {
    all += sum[lane];
  }
  return all;
}

template <typename Real>
inline double dotFlat(Index begin, Index end, const Real* a, const Real* b)
{
  using Pack = typename Wide<Real>::Pack;
  Pack sum = {};
  double rest = 0.0;
  forFlat<Real>(
      begin, end, [&](long i) { sum += loadAs<Pack>(a + i) * loadAs<Pack>(b + i); },
      [&](long i) { rest += a[i] * b[i]; });
  return total<Real>(sum) + rest;
}

template <typename Real>
void pack(const double* blocks, const Index* sources, Index begin, Index end, Real* values)
{
  using Four = typename Wide<Real>::Four;
  using Doubles = Wide<double>::Four;
  const Four zero = {};
  for (Index slot = begin; slot < end; ++slot)
  {
    if (sources[slot] == kNoBlock)
    {
      continue;
    }
    const bool upright = sources[slot] >= 0;
    const double* from = blocks + 9 * static_cast<long>(upright ? sources[slot] : ~sources[slot]);
    Real* to = values + 24 * static_cast<long>(slot / 2) + 4 * (slot % 2);
    const auto column = [&](int k) {
      const Four v = __builtin_convertvector(loadAs<Doubles>(from + 3 * k), Four);
      return __builtin_shufflevector(v, zero, 0, 1, 2, 4);
    };
    const Four a = column(0), b = column(1), c = column(2);
    if (upright)
    {
      storeTo(to, a);
      storeTo(to + 8, b);
      storeTo(to + 16, c);
    }
    else
    {
      const Four low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
      const Four high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
      storeTo(to, __builtin_shufflevector(low, c, 0, 1, 4, 7));
      storeTo(to + 8, __builtin_shufflevector(low, c, 2, 3, 5, 7));
      storeTo(to + 16, __builtin_shufflevector(high, c, 0, 1, 6, 7));
    }
  }
}

template <typename Real>
PcgSums precondition(Index begin, Index end, const Real* inverse, const Real* r, Real* z)
{
  using Four = typename Wide<Real>::Four;
  forNodes<Real>(begin, end, [&](Index node, auto store) {
    const Real* block = inverse + 9 * static_cast<long>(node);
    const Real* v = r + 3 * static_cast<long>(node);
    const Four sum = (loadAs<Four>(block) * v[0] + loadAs<Four>(block + 3) * v[1]) +
                     loadAs<Four>(block + 6) * v[2];
    store(z + 3 * static_cast<long>(node), sum);
  });
  return {dotFlat(begin, end, r, r), dotFlat(begin, end, r, z)};
}

/** Sums of a row: one per column of the blocks, for the first and the second of the pairs. */
template <typename Real>
struct PairSums
{
  typename Wide<Real>::Four first[3] = {}, second[3] = {};

  void add(const Real* pair, const Real* v, const Real* w)
  {
    using Four = typename Wide<Real>::Four;
    for (int k = 0; k < 3; ++k)
    {
      first[k] += loadAs<Four>(pair + 8 * k) * v[k];
      second[k] += loadAs<Four>(pair + 8 * k + 4) * w[k];
    }
  }

  typename Wide<Real>::Four total() const
  {
    return ((first[0] + first[1]) + first[2]) + ((second[0] + second[1]) + second[2]);
  }
};

#ifdef __AVX2__
template <>
struct PairSums<float>
{
  typedef float Eight __attribute__((vector_size(32)));
  Eight sum0 = {}, sum1 = {}, sum2 = {};

  void add(const float* pair, const float* v, const float* w)
  {
    using Four = Wide<float>::Four;
    const Eight both = __builtin_shufflevector(loadAs<Four>(v), loadAs<Four>(w),  //
                                               0, 1, 2, 3, 4, 5, 6, 7);
    sum0 += loadAs<Eight>(pair) * __builtin_shufflevector(both, both, 0, 0, 0, 0, 4, 4, 4, 4);
    sum1 += loadAs<Eight>(pair + 8) * __builtin_shufflevector(both, both, 1, 1, 1, 1, 5, 5, 5, 5);
    sum2 += loadAs<Eight>(pair + 16) * __builtin_shufflevector(both, both, 2, 2, 2, 2, 6, 6, 6, 6);
  }

  Wide<float>::Four total() const
  {
    const Eight sum = (sum0 + sum1) + sum2;
    return __builtin_shufflevector(sum, sum, 0, 1, 2, 3) +
           __builtin_shufflevector(sum, sum, 4, 5, 6, 7);
  }
};
#endif

template <typename Real>
void multiplyRows(const BlockRows<Real>& a, Index begin, Index end, const Real* p, Real* q)
{
  forNodes<Real>(begin, end, [&](Index row, auto store) {
    PairSums<Real> sums;
    for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k)
    {
      sums.add(a.values + 24 * static_cast<long>(k), p + 3 * static_cast<long>(a.columns[2 * k]),
               p + 3 * static_cast<long>(a.columns[2 * k + 1]));
    }
    store(q + 3 * static_cast<long>(row), sums.total());
  });
}

template <typename Real>
double multiply(const BlockRows<Real>& a, Index begin, Index end, const Real* p, Real* q)
{
  multiplyRows(a, begin, end, p, q);
  return dotFlat(begin, end, p, q);
}

template <typename Real>
PcgSums advance(Index begin, Index end, const Real* inverse, Real step, const Real* p, Real* d,
                Real* r, Real* q)
{
  using Pack = typename Wide<Real>::Pack;
  forFlat<Real>(
      begin, end,
      [&](long i) {
        storeTo(d + i, loadAs<Pack>(d + i) + step * loadAs<Pack>(p + i));
        storeTo(r + i, loadAs<Pack>(r + i) - step * loadAs<Pack>(q + i));
      },
      [&](long i) {
        d[i] += step * p[i];
        r[i] -= step * q[i];
      });
  return precondition(begin, end, inverse, r, q);
}

template <typename Real>
void turn(Index begin, Index end, Real ratio, const Real* z, Real* p)
{
  using Pack = typename Wide<Real>::Pack;
  forFlat<Real>(
      begin, end,
      [&](long i) { storeTo(p + i, loadAs<Pack>(z + i) + ratio * loadAs<Pack>(p + i)); },
      [&](long i) { p[i] = z[i] + ratio * p[i]; });
}

template <typename Real>
void gather(const NodeGroups<Real>& groups, Index begin, Index end, const Real* r, Real* c)
{
  using Four = typename Wide<Real>::Four;
  for (Index piece = begin; piece < end; ++piece)
  {
    Four force = {}, moment = {};
    for (Index i = groups.pieces[piece]; i < groups.pieces[piece + 1]; ++i)
    {
      const Four v = loadAs<Four>(r + 3 * static_cast<long>(i));
      force += v;
      moment += cross(loadAs<Four>(groups.arms + 3 * static_cast<long>(i)), v);
    }
    const Real sum[6] = {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
    std::memcpy(c + 6 * piece, sum, sizeof(sum));
  }
}

/** Rows of y = B c from `row` on, as many as kPacks hold. */
template <int kPacks, typename Real>
inline void multiplyRowsOf(Index size, Index row, const Real* b, const Real* c, Real* y)
{
  using Pack = typename Wide<Real>::Pack;
  constexpr Index kSize = sizeof(Pack) / sizeof(Real);
  Pack sum[kPacks] = {};
  for (Index k = 0; k < size; ++k)
  {
    const Real* column = b + static_cast<long>(size) * k + row;
    for (Index i = 0; i < kPacks; ++i)
    {
      sum[i] += loadAs<Pack>(column + i * kSize) * c[k];
    }
  }
  std::memcpy(y + row, sum, sizeof(sum));
}

/** Adds up columns, so that every number is the same sum in the same order whatever the width:
 * where rows don't fill the last registers some of those before are done once more. */
template <typename Real>
void multiplyDense(Index size, Index begin, Index end, const Real* b, const Real* c, Real* y)
{
  constexpr Index kSize = sizeof(typename Wide<Real>::Pack) / sizeof(Real);
  constexpr Index kPacks = 6, kMany = kPacks * kSize;
  if (end - begin >= kMany)
  {
    for (Index row = begin; row < end; row += kMany)
    {
      multiplyRowsOf<kPacks>(size, row < end - kMany ? row : end - kMany, b, c, y);
    }
    return;
  }
  if (end - begin >= kSize)
  {
    for (Index row = begin; row < end; row += kSize)
    {
      multiplyRowsOf<1>(size, row < end - kSize ? row : end - kSize, b, c, y);
    }
    return;
  }
  for (Index row = begin; row < end; ++row)
  {
    Real sum = 0;
    for (Index k = 0; k < size; ++k)
    {
      sum += b[static_cast<long>(size) * k + row] * c[k];
    }
    y[row] = sum;
  }
}

template <typename Real>
void spread(const NodeGroups<Real>& groups, Index begin, Index end, const Real* y, Real* z)
{
  using Four = typename Wide<Real>::Four;
  if (begin == end)
  {
    return;
  }
  const Real* first = z + 3 * static_cast<long>(begin);
  Four here = {first[0], first[1], first[2]};
  forNodes<Real>(begin, end, [&](Index node, auto store) {
    const Real* move = y + 6 * static_cast<long>(groups.group[node]);
    const Four turned =
        cross(loadAs<Four>(move + 3), loadAs<Four>(groups.arms + 3 * static_cast<long>(node)));
    const Four there = here + (loadAs<Four>(move) + turned);
    Real* to = z + 3 * static_cast<long>(node);
    if (node + 1 < end)
    {
      // Read before what is stored overlaps it, which would have to be waited for.
      const Four behind = loadAs<Four>(to + 2);
      here = __builtin_shufflevector(behind, behind, 1, 2, 3, 3);
    }
    store(to, there);
  });
}

template <typename Real>
const PcgKernels<Real>& pcgLoops()
{
  static const PcgKernels<Real> loops = {pack<Real>,         precondition<Real>,  multiply<Real>,
                                         multiplyRows<Real>, advance<Real>,       turn<Real>,
                                         gather<Real>,       multiplyDense<Real>, spread<Real>};
  return loops;
}

template const PcgKernels<float>& pcgLoops<float>();
template const PcgKernels<double>& pcgLoops<double>();

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
