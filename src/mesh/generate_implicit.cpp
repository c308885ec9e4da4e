#include <algorithm>
#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "work_mesh.h"

namespace soft_tissue
{
namespace
{
/** A shape as the place where a function is positive. */
struct Shape
{
  LevelFunction inside;
  LevelFunction nodule;  ///< empty if there is none
  Vec3 low;              ///< box around it; for a flat bottom low.z is the plane
  Vec3 high;
  Vec3 anchor = Vec3::Zero();
  double beside_anchor = 0.0;  ///< part of a cube by which a lattice node misses the anchor along x
  bool flat_bottom = false;
};

/** Lattice of that cube size with a node at or near the anchor; cut to shape. */
WorkMesh cutLattice(const Shape& shape, double cube_m)
{
  // A flat bottom fixes the layers' heights: align the nearest one, of corners or of centres.
  const long half_layers = std::lround((shape.anchor.z() - shape.low.z()) / (0.5 * cube_m));
  const double shift = shape.flat_bottom && half_layers % 2 == 1 ? 0.5 : 0.0;
  std::array<int, 3> cells;
  Vec3 low;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool fixed = axis == 2 && shape.flat_bottom;
    const double below = std::ceil((shape.anchor[axis] - shape.low[axis]) / cube_m) + 1.0 + shift;
    const double beside = axis == 0 ? shape.beside_anchor : 0.0;
    low[axis] = fixed ? shape.low[axis] : shape.anchor[axis] - (below + beside) * cube_m;
    cells[axis] = static_cast<int>(std::ceil((shape.high[axis] - low[axis]) / cube_m)) + 1;
  }
  WorkMesh work = makeLattice(low, cells, cube_m, shape.flat_bottom);
  if (shape.nodule)
  {
    snapToLevel(work, shape.nodule, kOnNodule);
    cutAtLevel(work, shape.nodule, kOnNodule, 1, kNoduleTag);
  }
  snapToLevel(work, shape.inside, kOnSurface);
  cutAtLevel(work, shape.inside, kOnSurface, 0, 0);
  compact(work);
  return work;
}

/** Chooses the cube size so that the tets are as many as asked for, within a few per cent. */
TetMesh meshShape(const Shape& shape, std::size_t tets, double first_cube_m)
{
  double cube_m = first_cube_m;
  WorkMesh best;
  double best_error = 1e300;
  for (int i = 0; i < 12 && best_error > 0.01; ++i)
  {
    WorkMesh work = cutLattice(shape, cube_m);
    const double ratio = static_cast<double>(work.mesh.tets.size()) / static_cast<double>(tets);
    if (std::abs(ratio - 1.0) < best_error)
    {
      best_error = std::abs(ratio - 1.0);
      best = std::move(work);
    }
    cube_m *= std::cbrt(ratio);
  }
  improveShapes(best, shape.inside, shape.nodule);
  return best.mesh;
}

double cubed(double x)
{
  return x * x * x;
}

/** Half an ellipsoid, thick and broad towards -x and +x, with a dent in its front edge. */
double lobeLevel(const Vec3& p)
{
  const double x = p.x() / 0.050;
  const double y = p.y() / (0.0395 * (1.0 + 0.18 * x));
  const double z = p.z() / (0.0380 * (1.0 - 0.33 * x));
  const Vec3 from_dent = (p - Vec3(0.012, -0.048, 0.012)) / 0.026;
  const double reach = 1.0 - from_dent.squaredNorm();
  const double dent = reach > 0.0 ? 0.55 * cubed(reach) : 0.0;
  return 1.0 - x * x - y * y - z * z - dent;
}

const Vec3 kNoduleCentre(-0.012, 0.006, 0.0263);
constexpr double kNoduleRadius = 0.009;

double noduleLevel(const Vec3& p)
{
  return kNoduleRadius - (p - kNoduleCentre).norm();
}

void needTets(std::size_t tets)
{
  if (tets < 500 || tets > 20000000)
  {
    throw Error("number of tets = " + std::to_string(tets) + ", must be in [500, 20000000]");
  }
}

void needPositive(bool good, const std::string& rule)
{
  if (!good)
  {
    throw Error("sizes must satisfy " + rule);
  }
}
}  // namespace

TetMesh makeBall(double radius_m, std::size_t tets)
{
  needTets(tets);
  needPositive(radius_m > 0.0 && radius_m < 1e6, "0 < radius_m < 1e6");
  Shape ball;
  ball.inside = [radius_m](const Vec3& p) { return radius_m - p.norm(); };
  ball.low = Vec3::Constant(-radius_m);
  ball.high = Vec3::Constant(radius_m);
  const double volume = 4.19 * cubed(radius_m);
  return meshShape(ball, tets, std::cbrt(12.0 * volume / static_cast<double>(tets)));
}

TetMesh makeTorus(double ring_radius_m, double tube_radius_m, std::size_t tets)
{
  needTets(tets);
  needPositive(tube_radius_m > 0.0 && ring_radius_m > tube_radius_m && ring_radius_m < 1e6,
               "0 < tube_radius_m < ring_radius_m < 1e6");
  Shape torus;
  torus.inside = [=](const Vec3& p) {
    const double ring = p.head<2>().norm() - ring_radius_m;
    return tube_radius_m - std::sqrt(ring * ring + p.z() * p.z());
  };
  const double reach = ring_radius_m + tube_radius_m;
  torus.high = Vec3(reach, reach, tube_radius_m);
  torus.low = -torus.high;
  const double volume = 19.7 * ring_radius_m * tube_radius_m * tube_radius_m;
  return meshShape(torus, tets, std::cbrt(12.0 * volume / static_cast<double>(tets)));
}

TetMesh makeLobe(std::size_t tets)
{
  needTets(tets);
  Shape lobe;
  lobe.inside = lobeLevel;
  lobe.nodule = noduleLevel;
  lobe.low = Vec3(-0.050, -0.042, 0.0);
  lobe.high = Vec3(0.050, 0.042, 0.041);
  lobe.anchor = kNoduleCentre;
  lobe.beside_anchor = 0.15;  // gives a coarse nodule more than one node inside
  lobe.flat_bottom = true;
  constexpr double kVolume_m3 = 1.5e-4;
  return meshShape(lobe, tets, std::cbrt(12.0 * kVolume_m3 / static_cast<double>(tets)));
}

}  // namespace soft_tissue
