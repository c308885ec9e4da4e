#pragma once

#include <Eigen/Geometry>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "soft_tissue_sim/energy/material.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace test
{
inline Mat3 randomMatrix(std::mt19937& random, double size)
{
  std::uniform_real_distribution<double> uniform(-size, size);
  Mat3 m;
  for (int k = 0; k < 9; ++k)
  {
    m.data()[k] = uniform(random);
  }
  return m;
}

inline Mat3 randomRotation(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

/** A deformation gradient with a name for messages. */
struct NamedF
{
  std::string name;
  Mat3 f;
  bool smooth = true;  ///< false where laws built on the polar rotation have none
};

/** Whether a law has derivatives where two stretches cancel as well. */
inline bool isSmooth(MaterialModel model)
{
  return model != MaterialModel::corotated;
}

/** Whether a law's energy is the same however the deformed body is turned. */
inline bool isBlindToRotations(MaterialModel model)
{
  return model != MaterialModel::linear;
}

/** Every law at an ordinary, a zero, an auxetic (where it takes that) and a nearly incompressible
 * Poisson's ratio. */
inline std::vector<std::tuple<MaterialModel, double>> lawsAndPoissonRatios()
{
  std::vector<std::tuple<MaterialModel, double>> all;
  for (const MaterialModel model : kMaterialModels)
  {
    for (const double poisson_ratio : {0.3, 0.0, -0.4, 0.49})
    {
      if (poisson_ratio >= leastPoissonRatio(model))
      {
        all.emplace_back(model, poisson_ratio);
      }
    }
  }
  return all;
}

/** F with the given signed singular values between random rotations. */
inline Mat3 stretched(std::mt19937& random, double a, double b, double c)
{
  return randomRotation(random) * Vec3(a, b, c).asDiagonal() * randomRotation(random);
}

/** Ordinary, degenerate and inverted deformation gradients. */
inline std::vector<NamedF> deformationGradients()
{
  std::mt19937 random(7);
  std::vector<NamedF> all;
  const Mat3 identity = Mat3::Identity();
  for (int k = 0; k < 5; ++k)
  {
    all.push_back(
        {"small strain", randomRotation(random) * (identity + randomMatrix(random, 0.02))});
    all.push_back(
        {"large strain", randomRotation(random) * (identity + randomMatrix(random, 0.4))});
    all.push_back({"squeezed to 1/5", stretched(random, 1.1, 0.9, 0.2)});
    all.push_back({"pulled to 3", stretched(random, 3.0, 0.6, 0.55)});
    all.push_back({"all of it doubled", stretched(random, 2.0, 2.0, 2.0)});
    all.push_back({"two equal stretches", stretched(random, 1.3, 0.8, 0.8)});
    all.push_back({"flat", stretched(random, 1.2, 0.7, 0.0)});
    all.push_back({"nearly flat", stretched(random, 1.2, 0.7, 1e-4)});
    all.push_back({"inverted", stretched(random, 1.2, 0.9, -0.5)});
    all.push_back({"slightly inverted", stretched(random, 1.2, 0.9, -1e-3)});
    all.push_back({"deeply inverted", stretched(random, 2.0, 1.5, -1.2)});
  }
  all.push_back({"rest", identity});
  all.push_back({"needle", stretched(random, 1.0, 0.0, 0.0), false});
  all.push_back({"point", Mat3::Zero(), false});
  all.push_back({"mirrored", Vec3(1, 1, -1).asDiagonal().toDenseMatrix(), false});
  return all;
}

/** Positions of the unit tet under F, moved off the origin. */
inline Points deformedUnitTet(const Mat3& f)
{
  const Vec3 shift(0.3, -0.2, 0.5);
  Points x;
  for (const Vec3& p : unitTet().nodes)
  {
    x.push_back(shift + f * p);
  }
  return x;
}

}  // namespace test
}  // namespace soft_tissue
