#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "soft_tissue_sim/energy/membrane_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/deformed_tets.h"

namespace soft_tissue::test
{
inline double areaOf(const TriMesh& mesh, const Triangle& t)
{
  const Vec3& a = mesh.nodes[t[0]];
  return 0.5 * (mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).norm();
}

inline Adjacency neighboursOf(const TriMesh& mesh)
{
  return membraneNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.triangles);
}

inline MembraneElasticity membrane(const TriMesh& mesh, const MembraneParameters& parameters)
{
  return MembraneElasticity(mesh,
                            std::vector<MembraneParameters>(mesh.triangles.size(), parameters), 0);
}

/** An irregular sheet of 3 x 3 cells of 1 m; a tenth as thick, so that bending counts. */
inline TriMesh smallSheet()
{
  return makeSheet({3, 3}, {3.0, 3.0}, SheetPattern::irregular);
}

/** Points of a flat sheet rolled around a line along y, radius in m. */
inline Points rolled(const Points& flat, double radius)
{
  Points x;
  for (const Vec3& p : flat)
  {
    const double angle = p.x() / radius;
    x.emplace_back(radius * std::sin(angle), p.y(), radius * (1.0 - std::cos(angle)));
  }
  return x;
}

inline Points shaken(const Points& points, double by, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-by, by);
  Points x = points;
  for (Vec3& p : x)
  {
    p += Vec3(uniform(random), uniform(random), uniform(random));
  }
  return x;
}

inline Points moved(const Points& points, const Mat3& f, const Vec3& shift = Vec3::Zero())
{
  Points x;
  for (const Vec3& p : points)
  {
    x.push_back(shift + f * p);
  }
  return x;
}

struct NamedShape
{
  std::string name;
  Points x;
  bool folded = false;  ///< by 180 degrees somewhere, beyond which angles begin anew
};

/** The small sheet in ordinary and in hard shapes, all where its energy is smooth. */
inline std::vector<NamedShape> sheetShapes()
{
  const Points flat = smallSheet().nodes;
  std::mt19937 random(5);
  const auto stretch = [&](double a, double b) {
    return Mat3(randomRotation(random) * Vec3(a, b, 1.0).asDiagonal() * randomRotation(random));
  };
  const Mat3 turned = randomRotation(random);
  std::vector<NamedShape> shapes = {
      {"rest", moved(flat, turned)},
      {"shaken", moved(shaken(flat, 0.1, 1), turned)},
      {"crumpled", shaken(flat, 0.4, 2)},
      {"pulled to 3", shaken(moved(flat, stretch(3.0, 0.6)), 0.01, 3)},
      {"all doubled", moved(shaken(flat, 0.2, 4), 2.0 * turned)},
      {"squeezed to 1/4", moved(shaken(flat, 0.1, 5), Vec3(0.25, 1.0, 1.0).asDiagonal())},
      {"squeezed to 1/20", moved(shaken(flat, 0.1, 6), Vec3(0.05, 1.0, 0.3).asDiagonal())},
      {"all a fifth", shaken(moved(flat, 0.2 * turned), 0.02, 7)},
      {"rolled up", shaken(rolled(flat, 0.7), 0.05, 8)}};
  return shapes;
}

/** The same with triangles that have lost their area altogether, and folds of 180 degrees. */
inline std::vector<NamedShape> collapsedShapes()
{
  const Points flat = smallSheet().nodes;
  std::vector<NamedShape> shapes = {
      {"line", moved(flat, Vec3(1.0, 0.0, 0.0).asDiagonal())},
      {"slanted line", moved(flat, Vec3(1.0, 0.3, 0.7) * Vec3(0.2, 0.5, 0.0).transpose())},
      {"point", moved(flat, Mat3::Zero())},
      {"nearly a line", moved(flat, Vec3(1.0, 1e-9, 0.0).asDiagonal())},
      {"nearly a point", moved(flat, 1e-160 * Mat3::Identity())}};
  Points one = flat, needle = flat, folded = flat;
  one[5] = one[6];
  needle[5] = 0.5 * (needle[6] + needle[10]);
  for (Vec3& p : folded)
  {
    p.x() = std::min(p.x(), 3.0 - p.x());
  }
  shapes.push_back({"edge without length", one});
  shapes.push_back({"node on an edge", needle, true});
  shapes.push_back({"folded flat", folded, true});
  return shapes;
}

}  // namespace soft_tissue::test
