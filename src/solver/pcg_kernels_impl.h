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
PcgSums precondition(Index begin, Index end, const Real* inverse, const Real* r, Real* z)
{
  using Four = typename Wide<Real>::Four;
  for (Index node = begin; node < end; ++node)
  {
    const Real* block = inverse + 9 * static_cast<long>(node);
    const Real* v = r + 3 * static_cast<long>(node);
    const Four sum = (loadAs<Four>(block) * v[0] + loadAs<Four>(block + 3) * v[1]) +
                     loadAs<Four>(block + 6) * v[2];
    Real* to = z + 3 * static_cast<long>(node);
    to[0] = sum[0];
    to[1] = sum[1];
    to[2] = sum[2];
  }
  return {dotFlat(begin, end, r, r), dotFlat(begin, end, r, z)};
}

template <typename Real>
void multiplyRows(const BlockRows<Real>& a, Index begin, Index end, const Real* p, Real* q)
{
  using Four = typename Wide<Real>::Four;
  for (Index row = begin; row < end; ++row)
  {
    // One running sum per column of the blocks; the fourth lane carries what the wide loads bring
    // along.
    Four sum0 = {}, sum1 = {}, sum2 = {};
    const Real* block = a.values + 9 * static_cast<long>(a.offsets[row]);
    for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k, block += 9)
    {
      const Real* v = p + 3 * static_cast<long>(a.columns[k]);
      sum0 += loadAs<Four>(block) * v[0];
      sum1 += loadAs<Four>(block + 3) * v[1];
      sum2 += loadAs<Four>(block + 6) * v[2];
    }
    const Four sum = (sum0 + sum1) + sum2;
    Real* to = q + 3 * static_cast<long>(row);
    to[0] = sum[0];
    to[1] = sum[1];
    to[2] = sum[2];
  }
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
  for (Index g = begin; g < end; ++g)
  {
    Real sum[6] = {};
    for (Index i = groups.offsets[g]; i < groups.offsets[g + 1]; ++i)
    {
      const Real* v = r + 3 * static_cast<long>(i);
      const Real* arm = groups.arms + 3 * static_cast<long>(i);
      sum[0] += v[0];
      sum[1] += v[1];
      sum[2] += v[2];
      sum[3] += arm[1] * v[2] - arm[2] * v[1];
      sum[4] += arm[2] * v[0] - arm[0] * v[2];
      sum[5] += arm[0] * v[1] - arm[1] * v[0];
    }
    std::memcpy(c + 6 * g, sum, sizeof(sum));
  }
}

/** Adds up columns, so that every number is the same sum in the same order whatever the width. */
template <typename Real>
void multiplyDense(Index size, Index begin, Index end, const Real* b, const Real* c, Real* y)
{
  using Pack = typename Wide<Real>::Pack;
  constexpr Index kSize = sizeof(Pack) / sizeof(Real);
  constexpr Index kPacks = 6;
  Index row = begin;
  for (; row + kPacks * kSize <= end; row += kPacks * kSize)
  {
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
  for (; row < end; ++row)
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
  for (Index node = begin; node < end; ++node)
  {
    const Real* move = y + 6 * static_cast<long>(groups.group[node]);
    const Real* arm = groups.arms + 3 * static_cast<long>(node);
    Real* to = z + 3 * static_cast<long>(node);
    to[0] += move[0] + (move[4] * arm[2] - move[5] * arm[1]);
    to[1] += move[1] + (move[5] * arm[0] - move[3] * arm[2]);
    to[2] += move[2] + (move[3] * arm[1] - move[4] * arm[0]);
  }
}

template <typename Real>
const PcgKernels<Real>& pcgLoops()
{
  static const PcgKernels<Real> loops = {precondition<Real>,  multiply<Real>, multiplyRows<Real>,
                                         advance<Real>,       turn<Real>,     gather<Real>,
                                         multiplyDense<Real>, spread<Real>};
  return loops;
}

template const PcgKernels<float>& pcgLoops<float>();
template const PcgKernels<double>& pcgLoops<double>();

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
