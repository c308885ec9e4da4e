#include <benchmark/benchmark.h>

#include "soft_tissue_sim/base/parallel.h"
#include "support/membranes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** An irregular sheet of 9940 triangles, its nodes moved by up to a tenth of a cell. */
struct ShakenSheet
{
  TriMesh mesh = makeSheet({70, 71}, {0.7, 0.71}, SheetPattern::irregular);
  MembraneElasticity term = membrane(mesh, {5000.0, 0.3, 0.001});
  Points x = shaken(mesh.nodes, 0.001, 1);
};

void setUp(benchmark::State& state)
{
  ShakenSheet sheet;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(membrane(sheet.mesh, {5000.0, 0.3, 0.001}));
  }
}

void value(benchmark::State& state)
{
  ShakenSheet sheet;
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(sheet.term.value(sheet.x));
  }
}

void valueAndGradient(benchmark::State& state)
{
  ShakenSheet sheet;
  Points gradient(sheet.x.size(), Vec3::Zero());
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(sheet.term.valueAndGradient(sheet.x, gradient));
  }
}

void hessian(benchmark::State& state, Curvature curvature)
{
  setThreadCount(static_cast<int>(state.range(0)));
  ShakenSheet sheet;
  BlockMatrix matrix(neighboursOf(sheet.mesh));
  for (auto _ : state)
  {
    sheet.term.addHessian(sheet.x, curvature, matrix);
  }
  setThreadCount(1);
}

BENCHMARK(setUp)->Unit(benchmark::kMillisecond);
BENCHMARK(value)->Unit(benchmark::kMillisecond);
BENCHMARK(valueAndGradient)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hessian, exact, Curvature::exact)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hessian, positive, Curvature::positive)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace soft_tissue
