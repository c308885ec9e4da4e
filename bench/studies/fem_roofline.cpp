#include "fem_roofline.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <numeric>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/solver/packed_rows.h"
#include "timing.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SOFT_TISSUE_EVERY_WIDTH __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define SOFT_TISSUE_EVERY_WIDTH
#endif

namespace soft_tissue::studies
{
namespace
{
constexpr int kTurns = 15;
constexpr std::size_t kBeyondCaches = std::size_t{1} << 23;  // doubles an array
constexpr double kLongEnough = 2e-3;                         // s, of what is timed at once

/** Of the thread, s. */
template <typename Work>
double secondsOf(const Work& work)
{
  int repeats = 1;
  for (double start = threadSeconds();; start = threadSeconds(), repeats *= 2)
  {
    for (int k = 0; k < repeats; ++k)
    {
      work();
    }
    if (threadSeconds() - start > kLongEnough)
    {
      break;
    }
  }
  std::vector<double> seconds;
  for (int turn = 0; turn < kTurns; ++turn)
  {
    const double start = threadSeconds();
    for (int k = 0; k < repeats; ++k)
    {
      work();
    }
    seconds.push_back((threadSeconds() - start) / repeats);
  }
  return median(seconds);
}

SOFT_TISSUE_EVERY_WIDTH
void triad(std::size_t count, const double* b, const double* c, double* a)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    a[i] = b[i] + 3.0 * c[i];
  }
}

/** Bytes a second of a = b + 3 c in arrays of this many bytes together. */
double bandwidth(std::size_t bytes)
{
  const std::size_t count = std::max<std::size_t>(bytes / (3 * sizeof(double)), 64);
  std::vector<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
  return 3.0 * sizeof(double) * static_cast<double>(count) /
         secondsOf([&] { triad(count, b.data(), c.data(), a.data()); });
}

constexpr int kChains = 96;  // sums that do not wait for each other, as many as registers hold

/** Products and sums, never fused: 2 rounds kChains operations. */
template <typename Real>
inline __attribute__((always_inline)) void multiplyAndAdd(int rounds, Real* sums)
{
  for (int k = 0; k < rounds; ++k)
  {
    for (int i = 0; i < kChains; ++i)
    {
      sums[i] = sums[i] * Real(0.999) + Real(0.001);
    }
  }
}

SOFT_TISSUE_EVERY_WIDTH
void multiplyAndAddDoubles(int rounds, double* sums)
{
  double local[kChains];
  std::copy(sums, sums + kChains, local);
  multiplyAndAdd(rounds, local);
  std::copy(local, local + kChains, sums);
}

SOFT_TISSUE_EVERY_WIDTH
void multiplyAndAddFloats(int rounds, float* sums)
{
  float local[kChains];
  std::copy(sums, sums + kChains, local);
  multiplyAndAdd(rounds, local);
  std::copy(local, local + kChains, sums);
}

constexpr int kRounds = 10000;
constexpr double kOperations = 2.0 * kRounds * kChains;

class RooflineTable
{
 public:
  explicit RooflineTable(const std::string& folder)
      : path_(folder + "/fem_roofline.csv"), stream_(path_), memory_(bandwidth(24 * kBeyondCaches))
  {
    std::vector<double> doubles(kChains, 1.0);
    std::vector<float> floats(kChains, 1.0F);
    const double real = secondsOf([&] { multiplyAndAddDoubles(kRounds, doubles.data()); });
    const double single = secondsOf([&] { multiplyAndAddFloats(kRounds, floats.data()); });
    peak_ = kOperations / real;
    single_peak_ = kOperations / single;
    std::printf("fem roofline: memory %.1f GB/s, peak %.1f Gflop/s, single %.1f\n", 1e-9 * memory_,
                1e-9 * peak_, 1e-9 * single_peak_);
    stream_ << "loop,tets,nodes,ms,mbytes,gb_per_s,triad_same_size_gb_per_s,memory_gb_per_s,"
               "gflop_per_s,peak_gflop_per_s\n";
  }

  /** @param operations  0: not counted */
  void add(const char* loop, const TetMesh& mesh, double seconds, double bytes, double operations,
           bool single)
  {
    char line[300];
    std::snprintf(line, sizeof(line), "%s,%zu,%zu,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n", loop,
                  mesh.tets.size(), mesh.nodes.size(), 1e3 * seconds, 1e-6 * bytes,
                  1e-9 * bytes / seconds, 1e-9 * bandwidth(static_cast<std::size_t>(bytes)),
                  1e-9 * memory_, 1e-9 * operations / seconds,
                  1e-9 * (single ? single_peak_ : peak_));
    stream_ << line << std::flush;
    std::printf("fem roofline: %s", line);
    if (!stream_)
    {
      throw Error(path_ + ": can't be written");
    }
  }

 private:
  std::string path_;
  std::ofstream stream_;
  double memory_ = 0.0, peak_ = 0.0, single_peak_ = 0.0;  ///< bytes and operations a second
};

template <typename Real>
void measureProduct(RooflineTable& table, const char* loop, const TetMesh& mesh,
                    const BlockMatrix& matrix)
{
  const double blocks = static_cast<double>(matrix.columns().size());
  const double rows = matrix.rows();
  const PcgKernels<Real>& kernels = pcgKernels<Real>(instructionSet());
  std::vector<Index> order(matrix.rows());
  std::iota(order.begin(), order.end(), 0);
  PackedRows<Real> packed;
  packed.takePattern(matrix, order, order);
  const std::vector<double> values(matrix.values().size(), 0.5);
  packed.load(kernels, values.data(), 0, matrix.rows());
  const BlockRows<Real> a = packed.view();
  const std::vector<Real> p(3 * mesh.nodes.size() + 1, Real(1.0));
  std::vector<Real> q(p.size());
  double product = 0.0;
  const double seconds =
      secondsOf([&] { product += kernels.multiply(a, 0, matrix.rows(), p.data(), q.data()); });
  if (!(product > 0.0))
  {
    throw Error("the product came out as zero");
  }
  // Pairs of blocks, their columns, offsets, p and q; a product and a sum per number, and p . q.
  const double pairs = a.offsets[matrix.rows()];
  table.add(loop, mesh, seconds, pairs * (24 * sizeof(Real) + 8) + rows * (4 + 6 * sizeof(Real)),
            18.0 * blocks + 6.0 * rows, sizeof(Real) == sizeof(float));
}
}  // namespace

void studyRoofline(const std::string& folder, bool quick)
{
  setThreadCount(1);
  RooflineTable table(folder);
  for (const int tets : quick ? std::vector<int>{1000} : std::vector<int>{5000, 20000, 500000})
  {
    const Vec3 size(0.1, 0.02, 0.02);
    const TetMesh mesh = makeBox(cellsForBox(size, tets), size);
    const auto nodes = static_cast<Index>(mesh.nodes.size());
    BlockMatrix matrix(nodeNeighbours(nodes, mesh.tets));
    measureProduct<float>(table, "product single", mesh, matrix);
    measureProduct<double>(table, "product double", mesh, matrix);
    TetElasticity elasticity(mesh, MaterialModel::neo_hookean,
                             std::vector<TetStiffnessParameters>(mesh.tets.size(), {5000.0, 0.45}),
                             0);
    Points gradient(mesh.nodes.size(), Vec3::Zero());
    const double count = static_cast<double>(mesh.tets.size());
    // Of a tet nodes, rest gradients, volume, constants, energy; of a node x, and forces twice.
    // Operations: edges 9, F 45, cofactors and det F 32, |F|^2 17, stress 37, forces 63, sums 12.
    table.add("forces", mesh, secondsOf([&] { elasticity.valueAndGradient(mesh.nodes, gradient); }),
              count * (16 + 72 + 8 + 32 + 8) + 72.0 * nodes, 215.0 * count, false);
    // The same without energies, and places in the matrix; each block of a triangle twice.
    const double upper = 0.5 * (static_cast<double>(matrix.columns().size()) + nodes);
    table.add("stiffness", mesh,
              secondsOf([&] { elasticity.addHessian(mesh.nodes, Curvature::exact, matrix); }),
              count * (16 + 72 + 8 + 32 + 40) + 24.0 * nodes + 144.0 * upper, 0.0, false);
  }
}

}  // namespace soft_tissue::studies
