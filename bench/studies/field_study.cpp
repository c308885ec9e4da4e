#include "field_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numeric>

#include "closest_point_tree.h"
#include "deformed_field_study.h"
#include "distance_volume.h"
#include "field_bodies.h"
#include "field_table.h"
#include "soft_tissue_sim/field/grid_field.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue::studies
{
namespace
{
/** More boundary triangles times nodes than that are too many for brute force. */
constexpr double kMostPairs = 3e8;

/** The true depths: of all triangles one after the other, or where those are too many, by a tree
 * without any hint, which tests hold against brute force. */
std::vector<double> trueDepths(const FieldBody& body)
{
  const std::vector<Triangle>& triangles = body.surface.triangles;
  const bool brute = static_cast<double>(body.x.size()) * triangles.size() <= kMostPairs;
  TriangleTree tree;
  tree.build(triangles, body.x);
  std::vector<double> depths;
  for (const Vec3& p : body.x)
  {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; brute && i < triangles.size(); ++i)
    {
      const Triangle& t = triangles[i];
      least = std::min(
          least, closestOnTriangle(p, body.x[t[0]], body.x[t[1]], body.x[t[2]]).squared_distance);
    }
    depths.push_back(std::sqrt(brute ? least : tree.nearest(p, body.x).point.squared_distance));
  }
  return depths;
}

/** The one percent of all nodes that are nearest to the lowest one: what a contact there touches.
 */
std::vector<Index> touchedPercent(const FieldBody& body)
{
  const int up = body.dimension - 1;
  const Vec3 spot = *std::min_element(body.x.begin(), body.x.end(),
                                      [&](const Vec3& a, const Vec3& b) { return a[up] < b[up]; });
  std::vector<Index> nodes(body.x.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::sort(nodes.begin(), nodes.end(), [&](Index a, Index b) {
    return (body.x[a] - spot).squaredNorm() < (body.x[b] - spot).squaredNorm();
  });
  nodes.resize(nodes.size() / 100);
  return nodes;
}

/** Grids read at the nodes: linearly, as both papers do, and by slopes; and at a body's middle. */
void studyGrids(Table& table, const FieldBody& body, const std::vector<int>& resolutions,
                int repeats)
{
  const std::vector<double> truth = trueDepths(body);
  const Box3 box = boundsOf(body.x);
  FieldBody middle;  // a body of one node
  middle.name = body.name + " centre";
  middle.dimension = body.dimension;
  middle.elements = body.elements;
  middle.x = {0.5 * (box.min + box.max)};
  middle.surface.node_slot = {-1};
  TriangleTree tree;
  tree.build(body.surface.triangles, body.x);
  const double centre = std::sqrt(tree.nearest(middle.x[0], body.x).point.squared_distance);
  for (const GridOrder order : {GridOrder::first, GridOrder::second})
  {
    for (const int resolution : resolutions)
    {
      GridField field(
          GridSpec::around(box, {resolution, resolution, body.dimension == 3 ? resolution : 1}),
          order);
      const std::uint64_t before = field.evaluations();
      const double ms = timed(repeats, [&] { field.march(body.surface, body.x); });
      const std::uint64_t evaluations = (field.evaluations() - before) / repeats;
      if (body.dimension == 3)
      {
        // An octant, where nothing has moved, as for the first paper's "1/8 update".
        const Box3 octant = {0.5 * (box.min + box.max), box.max};
        const std::uint64_t start = field.evaluations();
        const double update_ms =
            timed(repeats, [&] { field.update({octant}, body.surface, body.x); });
        std::vector<double> updated;
        for (const Vec3& p : body.x)
        {
          updated.push_back(field.interpolate(p));
        }
        table.add(body, {"grid update 1/8", order == GridOrder::second ? 2 : 1, resolution},
                  update_ms, updated, truth, (field.evaluations() - start) / repeats);
        field.march(body.surface, body.x);
      }
      std::vector<double> linear, slopes;
      for (const Vec3& p : body.x)
      {
        linear.push_back(field.interpolate(p));
        slopes.push_back(field.extrapolate(p));
      }
      const int number = order == GridOrder::second ? 2 : 1;
      table.add(body, {"grid", number, resolution}, ms, linear, truth, evaluations);
      table.add(body, {"grid slopes", number, resolution}, ms, slopes, truth, evaluations);
      if (!(field.interpolate(middle.x[0]) > 0.0))  // a ring has nothing there
      {
        continue;
      }
      table.add(middle, {"grid", number, resolution}, ms, {field.interpolate(middle.x[0])},
                {centre}, evaluations);
      table.add(middle, {"grid slopes", number, resolution}, ms, {field.extrapolate(middle.x[0])},
                {centre}, evaluations);
    }
  }
}

void studyBody(Table& table, const FieldBody& body, int repeats,
               const std::vector<int>& volume_resolutions)
{
  const std::vector<double> truth = trueDepths(body);
  for (const char* method : {"cpfm", "cffm", "exact_marching"})
  {
    // The first march, with what it prepares, and those after it.
    std::unique_ptr<DistanceField> field;
    const double first_ms = timed(repeats, [&] {
      field = makeDistanceField(method, body.topology());
      field->march(body.x);
    });
    table.add(body, {std::string(method) + " first"}, first_ms, field->depth(), truth,
              field->evaluations());
    std::uint64_t before = field->evaluations();
    const double again_ms = timed(repeats, [&] { field->march(body.x); });
    table.add(body, {method}, again_ms, field->depth(), truth,
              (field->evaluations() - before) / repeats);
    const std::vector<Index> wanted = touchedPercent(body);
    before = field->evaluations();
    const double lazy_ms = timed(repeats, [&] { field->marchUntil(body.x, wanted); });
    table.add(body, {std::string(method) + " lazy 1 %"}, lazy_ms, field->depth(), truth,
              (field->evaluations() - before) / repeats);
  }
  if (haveCgal() && body.dimension == 3)
  {
    std::vector<double> depths;
    const double ms = timed(std::min(repeats, 3), [&] {
      depths = cgalDistances(body.x, body.surface.triangles, body.x);
    });
    table.add(body, {"cgal tree"}, ms, depths, truth, 0);
  }
  if (haveOpenVdb() && body.dimension == 3)
  {
    const Box3 box = boundsOf(body.x);
    for (const int resolution : volume_resolutions)
    {
      std::vector<double> depths;
      const double voxel = (box.max - box.min).maxCoeff() / resolution;
      const double ms = timed(std::min(repeats, 3), [&] {
        depths = openVdbDepths(body.x, body.surface.triangles, body.x, voxel);
      });
      table.add(body, {"openvdb", 0, resolution}, ms, depths, truth, 0);
    }
  }
}
}  // namespace

void studyFields(const std::string& folder, bool quick)
{
  Table table(folder);
  const int repeats = quick ? 1 : 7;
  const std::vector<int> volumes =
      quick ? std::vector<int>{25} : std::vector<int>{25, 50, 100, 200};
  for (const FieldBody& body : {disc(), rectangle(40, 25), cutRectangle(40, 25)})
  {
    studyBody(table, body, repeats, {});
    studyGrids(table, body, {20, 100}, repeats);
  }
  for (const std::size_t tets : {5000, 20000, 100000, 300000, 1000000})
  {
    if (!quick || tets <= 20000)
    {
      studyBody(table, bodyOfTets("ball", makeBall(1.0, tets)), tets > 500000 ? 3 : repeats,
                volumes);
    }
  }
  const std::vector<FieldBody> bodies = {
      bodyOfTets("torus", makeTorus(1.0, 0.4, quick ? 5000 : 100000)),
      bodyOfTets("lobe", makeLobe(quick ? 5000 : 100000))};
  for (const FieldBody& body : bodies)
  {
    studyBody(table, body, repeats, volumes);
  }
  // The first paper's two tables.
  studyGrids(table, sphereOfTriangles(),
             quick ? std::vector<int>{20, 40} : std::vector<int>{20, 30, 40, 50, 55, 60}, repeats);
  studyGrids(table, torusOfTriangles(), {50}, repeats);
  studyGrids(table, appleOfTriangles(), {50}, repeats);
  studyDeformedFields(table, quick);
  if (!haveCgal())
  {
    std::printf("built without CGAL: no \"cgal tree\" to compare with (-DSOFT_TISSUE_BENCH=ON)\n");
  }
  if (!haveOpenVdb())
  {
    std::printf("built without OpenVDB: no \"openvdb\" to compare with (-DSOFT_TISSUE_BENCH=ON)\n");
  }
}

}  // namespace soft_tissue::studies
