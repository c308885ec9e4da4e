#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "soft_tissue_sim/contact/tissue_depth.h"
#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
constexpr double kRadius = 0.05;

/** Six tets a cell: 9 cells a side are 4,374 tets, 20 are 48,000. */
test::FieldBody ball(const benchmark::State& state)
{
  return test::FieldBody(test::ballMesh(static_cast<int>(state.range(0)), kRadius));
}

void report(benchmark::State& state, const test::FieldBody& body, const DistanceField& field)
{
  std::size_t marched = 0;
  for (std::size_t node = 0; node < body.mesh.nodes.size(); ++node)
  {
    marched += body.surface.node_slot[node] < 0 && field.closestTriangle()[node] >= 0;
  }
  state.counters["tets"] = static_cast<double>(body.mesh.tets.size());
  state.counters["nodes"] = static_cast<double>(body.mesh.nodes.size());
  state.counters["marched_inner_nodes"] = static_cast<double>(marched);
}

void marchFull(benchmark::State& state)
{
  const test::FieldBody body = ball(state);
  const auto field = body.field();
  for (auto _ : state)
  {
    field->march(body.mesh.nodes);
    benchmark::DoNotOptimize(field->depth().data());
  }
  report(state, body, *field);
}

/** What a contact needs: all nodes of the one percent of tets that lie lowest. */
void marchLazyOnePercent(benchmark::State& state)
{
  const test::FieldBody body = ball(state);
  const auto field = body.field();
  std::vector<std::pair<double, Index>> by_height;
  for (std::size_t t = 0; t < body.mesh.tets.size(); ++t)
  {
    double height = 0.0;
    for (const Index node : body.mesh.tets[t])
    {
      height += body.mesh.nodes[node].z();
    }
    by_height.emplace_back(height, static_cast<Index>(t));
  }
  std::sort(by_height.begin(), by_height.end());
  std::vector<Index> wanted;
  for (std::size_t i = 0; i < by_height.size() / 100; ++i)
  {
    const Tet& tet = body.mesh.tets[by_height[i].second];
    wanted.insert(wanted.end(), tet.begin(), tet.end());
  }
  for (auto _ : state)
  {
    field->marchUntil(body.mesh.nodes, wanted);
    benchmark::DoNotOptimize(field->depth().data());
  }
  report(state, body, *field);
}

/** The depth of one inner point a call, by the nearest boundary feature. */
void depthOfPoint(benchmark::State& state)
{
  const test::FieldBody body = ball(state);
  const Points& x = body.mesh.nodes;
  const auto field = body.field();
  field->march(x);
  TissueBody tissue;
  tissue.tets = &body.mesh.tets;
  tissue.surface = &body.surface;
  tissue.node_count = static_cast<Index>(x.size());
  TissueDepth depth(tissue, true);
  depth.prepare(x);
  Index next = 0;
  for (auto _ : state)
  {
    const Tet& tet = body.mesh.tets[next];
    const Vec3 p = 0.25 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]);
    ContactSample sample;
    NearBoundary near;
    benchmark::DoNotOptimize(depth.evaluate(p, next, x, *field, near, sample));
    benchmark::DoNotOptimize(sample.depth);
    next = (next + 7919) % static_cast<Index>(body.mesh.tets.size());
  }
}

BENCHMARK(marchFull)->Arg(9)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(marchLazyOnePercent)->Arg(9)->Arg(20)->Unit(benchmark::kMillisecond);
BENCHMARK(depthOfPoint)->Arg(9)->Arg(20)->Unit(benchmark::kMicrosecond);
}  // namespace
}  // namespace soft_tissue
