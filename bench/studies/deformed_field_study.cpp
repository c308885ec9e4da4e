#include "deformed_field_study.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "soft_tissue_sim/geometry/triangle_tree.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue::studies
{
namespace
{
using Map = std::function<Vec3(const Vec3&)>;

/** Points in tets, by weights of their corners. */
struct Probes
{
  std::vector<Index> tets;
  std::vector<Eigen::Vector4d> weights;
};

Probes randomProbes(const TetMesh& mesh, std::size_t count)
{
  std::mt19937 random(1);
  Probes probes;
  for (std::size_t i = 0; i < count; ++i)
  {
    Eigen::Vector4d weights;
    for (double& weight : weights)
    {
      weight = -std::log((random() + 1.0) / 4294967297.0);  // even over the tet
    }
    probes.tets.push_back(static_cast<Index>(random() % mesh.tets.size()));
    probes.weights.push_back(weights / weights.sum());
  }
  return probes;
}

std::vector<double> interpolated(const TetMesh& mesh, const Probes& probes,
                                 const std::vector<double>& depth)
{
  std::vector<double> result;
  for (std::size_t i = 0; i < probes.tets.size(); ++i)
  {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
    {
      sum += probes.weights[i][k] * depth[mesh.tets[probes.tets[i]][k]];
    }
    result.push_back(sum);
  }
  return result;
}

void studyDeformation(Table& table, const std::string& name, const TetMesh& mesh, const Map& map,
                      int repeats)
{
  const FieldBody body = bodyOfTets(name, mesh);
  Points x;
  for (const Vec3& p : mesh.nodes)
  {
    x.push_back(map(p));
  }
  const Probes probes = randomProbes(mesh, 2000);
  TriangleTree tree;
  tree.build(body.surface.triangles, x);
  FieldBody points;  // as if they were nodes
  points.name = name;
  points.elements = mesh.tets.size();
  points.surface.node_slot.assign(probes.tets.size(), -1);
  std::vector<double> truth;
  for (std::size_t i = 0; i < probes.tets.size(); ++i)
  {
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      p += probes.weights[i][k] * x[mesh.tets[probes.tets[i]][k]];
    }
    points.x.push_back(p);
    truth.push_back(std::sqrt(tree.nearest(p, x).point.squared_distance));
  }
  for (const char* method : {"cffm", "exact_marching"})
  {
    const std::unique_ptr<DistanceField> field = makeDistanceField(method, body.topology());
    field->march(mesh.nodes);
    std::vector<double> depths;
    double ms = timed(repeats, [&] { depths = interpolated(mesh, probes, field->depth()); });
    table.add(points, {std::string("carried ") + method}, ms, depths, truth, 0);
    ms = timed(repeats, [&] {
      field->march(x);
      depths = interpolated(mesh, probes, field->depth());
    });
    table.add(points, {std::string("interpolated ") + method}, ms, depths, truth, 0);
    if (method != std::string("exact_marching"))
    {
      continue;
    }
    std::uint64_t evaluations = 0;
    ms = timed(repeats, [&] {
      tree.refit(x);
      depths.clear();
      evaluations = 0;
      for (std::size_t i = 0; i < probes.tets.size(); ++i)
      {
        const Index hint = field->closestTriangle()[mesh.tets[probes.tets[i]][0]];
        const TriangleTree::Nearest found = tree.nearest(points.x[i], x, hint);
        depths.push_back(std::sqrt(found.point.squared_distance));
        evaluations += found.evaluations;
      }
    });
    table.add(points, {"closest feature"}, ms, depths, truth, evaluations);
  }
}
}  // namespace

void studyDeformedFields(Table& table, bool quick)
{
  const int repeats = quick ? 1 : 7;
  const std::size_t tets = quick ? 5000 : 20000;
  const double length = 0.4;
  const Map bend = [=](const Vec3& p) {  // by 90 degrees
    const double radius = length / (0.5 * M_PI), angle = p.x() / radius;
    return Vec3((radius - p.z()) * std::sin(angle), p.y(), -(radius - p.z()) * std::cos(angle));
  };
  const Map twist = [=](const Vec3& p) {  // by 180 degrees
    const Vec3 axis(0.0, 0.05, 0.05);
    return Vec3(axis + Eigen::AngleAxisd(M_PI * p.x() / length, Vec3::UnitX()) * (p - axis));
  };
  const auto squash = [](double share) {
    return [share](const Vec3& p) { return Vec3(p.x(), p.y(), share * p.z()); };
  };
  const TetMesh beam = makeBox({32, 8, 8}, {length, 0.1, 0.1});
  studyDeformation(table, "squashed ball", makeBall(1.0, tets), squash(0.7), repeats);
  studyDeformation(table, "bent beam", beam, bend, repeats);
  studyDeformation(table, "twisted beam", beam, twist, repeats);
  studyDeformation(table, "pressed lobe", makeLobe(tets), squash(0.5), repeats);
  studyDeformation(table, "bent one tet thick", makeBox({16, 4, 1}, {length, 0.1, 0.02}), bend,
                   repeats);
}

}  // namespace soft_tissue::studies
