#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "membrane_patches.h"

namespace soft_tissue
{
namespace
{
using Vec2 = Eigen::Vector2d;
using Solver = Eigen::SelfAdjointEigenSolver<Mat3>;

constexpr int kSweeps = 40;
/** A stiffness may not fall below this share of what the curvature of six nodes has. */
constexpr double kSoftest = 0.05;
/** Six nodes near a conic tell no curvature: this share of the softness is added. */
constexpr double kSoftened = 1e-4;

/** Curvatures are (k11, k22, sqrt(2) k12), which turn like vectors; moments do work on them. */
const double kRoot2 = std::sqrt(2.0);

Mat3 plateStiffness(const MembraneParameters& p)
{
  const double nu = p.poisson_ratio;
  const double d =
      p.young_modulus * p.thickness * p.thickness * p.thickness / (12.0 * (1.0 - nu * nu));
  const double lateral = -std::abs(nu);
  Mat3 stiffness;
  stiffness << d, lateral * d, 0.0, lateral * d, d, 0.0, 0.0, 0.0, (1.0 - lateral) * d;
  return stiffness;
}

/** Curvatures in axes t and n of those in the axes t and n are given in. */
Mat3 turnedInto(const Vec2& t, const Vec2& n)
{
  Mat3 m;
  m << t.x() * t.x(), t.y() * t.y(), kRoot2 * t.x() * t.y(), n.x() * n.x(), n.y() * n.y(),
      kRoot2 * n.x() * n.y(), kRoot2 * t.x() * n.x(), kRoot2 * t.y() * n.y(),
      t.x() * n.y() + t.y() * n.x();
  return m;
}

/** Angle per curvature (along the edge, across, mixed), two triangles unfolded into a plane. */
Vec3 anglePerCurvature(const Points& x, const MembraneAngle& angle)
{
  const Vec3 edge = x[angle.nodes[1]] - x[angle.nodes[0]];
  const double length = edge.norm();
  Vec3 m = Vec3::Zero();
  for (int side = 0; side < 2; ++side)
  {
    const Vec3 arm = x[angle.nodes[2 + side]] - x[angle.nodes[0]];
    const double along = arm.dot(edge) / length, height = edge.cross(arm).norm() / length;
    m += Vec3(0.5 * along * (along - length) / height, 0.5 * height,
              (side == 0 ? along : -along) / kRoot2);
  }
  return m;
}

/** A triangle's part of the fit, in a frame of its own plane. */
struct Fit
{
  Mat3 turn[3];           ///< per edge: curvatures into the angle's frame
  Mat3 m = Mat3::Zero();  ///< rows: angle per curvature
  Mat3 w = Mat3::Zero();
  Mat3 root = Mat3::Identity(), inverse_root = Mat3::Identity();  ///< Cholesky factor of W0
  Mat3 axes;                                                      ///< eigenvectors of m m^T
  Vec3 sizes;                                                     ///< and its eigenvalues

  void begin(const MembranePatch& patch, const Mat3& plate, double area)
  {
    Mat3 softness = m * plate.inverse() * m.transpose() / area;
    softness.diagonal() *= 1.0 + kSoftened;
    for (int k = 0; k < 3; ++k)
    {
      softness(k, k) = patch.angles[k] < 0 ? 1.0 : softness(k, k);
    }
    w = softness.inverse();
    w = 0.5 * (w + w.transpose()).eval();
    root = Eigen::LLT<Mat3>(w).matrixL();
    inverse_root = root.inverse();
    const Solver solver(m * m.transpose());
    axes = solver.eigenvectors();
    sizes = solver.eigenvalues().cwiseMax(0.0);
    clear(patch);
  }

  /** Adds the symmetric matrix that comes closest to changing w m by `change`. */
  void follow(const Mat3& change)
  {
    Mat3 right = change * m.transpose();
    right = (axes.transpose() * (right + right.transpose()) * axes).eval();
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const double size = sizes[i] + sizes[j];
        right(i, j) = size > 1e-12 * sizes[2] ? right(i, j) / size : 0.0;
      }
    }
    w += axes * right * axes.transpose();
  }

  void keepPositive(const MembranePatch& patch)
  {
    const Mat3 relative = inverse_root * w * inverse_root.transpose();
    const Solver solver(0.5 * (relative + relative.transpose()));
    const Mat3 back = root * solver.eigenvectors();
    w = back * solver.eigenvalues().cwiseMax(kSoftest).asDiagonal() * back.transpose();
    w = 0.5 * (w + w.transpose()).eval();
    clear(patch);
  }

  void clear(const MembranePatch& patch)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (patch.angles[k] < 0)
      {
        w.row(k).setZero();
        w.col(k).setZero();
      }
    }
  }
};

Fit startFit(const Points& x, const MembranePatches& mesh, const MembranePatch& patch,
             const std::vector<Vec3>& angles, const Mat3& plate)
{
  const Vec3 origin = x[patch.nodes[0]];
  const Vec3 edge = x[patch.nodes[1]] - origin;
  const Vec3 normal = edge.cross(x[patch.nodes[2]] - origin);
  const Vec3 axis1 = edge.normalized(), axis2 = normal.cross(edge).normalized();
  Fit fit;
  for (int k = 0; k < 3; ++k)
  {
    if (patch.angles[k] < 0)
    {
      continue;
    }
    const MembraneAngle& angle = mesh.angles[patch.angles[k]];
    const Vec3 along = (x[angle.nodes[1]] - x[angle.nodes[0]]).normalized();
    const Vec2 t(along.dot(axis1), along.dot(axis2));
    const Vec3 inward = x[patch.nodes[(k + 2) % 3]] - x[angle.nodes[0]];
    Vec2 n(-t.y(), t.x());
    const bool first = patch.places[k][2] < 3;
    const bool flip = (n.dot(Vec2(inward.dot(axis1), inward.dot(axis2))) > 0.0) != first;
    n = flip ? Vec2(-n) : n;
    fit.turn[k] = patch.sides[k] * turnedInto(t, n);
    fit.m.row(k) = angles[patch.angles[k]].transpose() * fit.turn[k];
  }
  fit.begin(patch, plate, 0.5 * normal.norm());
  return fit;
}
}  // namespace

std::vector<AngleStiffness> fitAngleStiffness(const TriMesh& rest, const MembranePatches& mesh,
                                              const std::vector<MembraneParameters>& parameters)
{
  std::vector<Vec3> angles, wanted;
  for (const MembraneAngle& angle : mesh.angles)
  {
    angles.push_back(anglePerCurvature(rest.nodes, angle));
    const Mat3 plates = plateStiffness(parameters[angle.triangles[0]]) +
                        plateStiffness(parameters[angle.triangles[1]]);
    const double length = (rest.nodes[angle.nodes[1]] - rest.nodes[angle.nodes[0]]).norm();
    wanted.push_back(0.5 * length * plates.col(1));  // across the edge is the second of three
  }
  std::vector<Fit> fits;
  for (std::size_t t = 0; t < mesh.patches.size(); ++t)
  {
    fits.push_back(
        startFit(rest.nodes, mesh, mesh.patches[t], angles, plateStiffness(parameters[t])));
  }
  std::vector<Vec3> missing(wanted.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep)
  {
    missing = wanted;
    for (std::size_t t = 0; t < fits.size(); ++t)
    {
      const Mat3 moments = fits[t].w * fits[t].m;
      for (int k = 0; k < 3; ++k)
      {
        if (mesh.patches[t].angles[k] >= 0)
        {
          missing[mesh.patches[t].angles[k]] -= fits[t].turn[k] * moments.row(k).transpose();
        }
      }
    }
    for (std::size_t t = 0; t < fits.size(); ++t)
    {
      Mat3 change = Mat3::Zero();
      for (int k = 0; k < 3; ++k)
      {
        if (mesh.patches[t].angles[k] >= 0)
        {
          change.row(k) = 0.5 * missing[mesh.patches[t].angles[k]].transpose() * fits[t].turn[k];
        }
      }
      fits[t].follow(change);
      fits[t].keepPositive(mesh.patches[t]);
    }
  }
  std::vector<AngleStiffness> stiffness;
  for (const Fit& fit : fits)
  {
    const Mat3& w = fit.w;
    stiffness.push_back({w(0, 0), w(0, 1), w(0, 2), w(1, 1), w(1, 2), w(2, 2)});
  }
  return stiffness;
}

}  // namespace soft_tissue
