#pragma once

#include <Eigen/SVD>
#include <cmath>
#include <map>
#include <tuple>

#include "soft_tissue_sim/energy/tet_elasticity.h"

namespace soft_tissue::test
{
/** Deformation gradient of a tet. */
inline Mat3 deformationOf(const TetMesh& rest, const Tet& tet, const Vec3* x)
{
  Mat3 before, after;
  for (int k = 0; k < 3; ++k)
  {
    before.col(k) = rest.nodes[tet[k + 1]] - rest.nodes[tet[0]];
    after.col(k) = x[tet[k + 1]] - x[tet[0]];
  }
  return after * before.inverse();
}

/** What a law calls dilatation. */
inline double dilatationOf(MaterialModel model, const Mat3& f)
{
  switch (model)
  {
    case MaterialModel::corotated: {
      const Eigen::JacobiSVD<Mat3> svd(f);
      const Vec3 s = svd.singularValues();
      return s[0] + s[1] + (f.determinant() < 0.0 ? -s[2] : s[2]) - 3.0;
    }
    case MaterialModel::st_venant_kirchhoff:
      return 0.5 * (f.squaredNorm() - 3.0);
    case MaterialModel::linear:
      return f.trace() - 3.0;
    default:
      return f.determinant();
  }
}

/** What lambda weighs, of a dilatation. */
inline double volumeEnergyOf(MaterialModel model, double d)
{
  switch (model)
  {
    case MaterialModel::neo_hookean_log: {
      const double at = std::max(d, kLeastLogVolume), below = d - at, l = std::log(at);
      return 0.5 * l * l + below * l / at + 0.5 * below * below * (1.0 - l) / (at * at);
    }
    case MaterialModel::neo_hookean:
    case MaterialModel::exponential:
      return 0.5 * (d - 1.0) * (d - 1.0);
    default:
      return 0.5 * d * d;
  }
}

/** Energy of tets whose lambda meets the means of nodes, as NodalPressureElasticity says it: tet by
 * tet, node by node. */
inline double nodalPressureEnergy(const TetMesh& mesh, MaterialModel model,
                                  const std::vector<TetStiffnessParameters>& parameters,
                                  const Points& x, Index first_node)
{
  struct Mean
  {
    double volume = 0.0, dilatation = 0.0;
  };
  std::map<std::tuple<Index, double, double>, Mean> means;  // by node, mu, lambda
  double energy = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    TetMesh one = mesh;
    one.tets = {mesh.tets[t]};
    one.tags = {0};
    const Lame lame = lameFrom(parameters[t].young_modulus, parameters[t].poisson_ratio);
    TetStiffnessParameters rest = parameters[t];
    if (lame.lambda > 0.0)
    {
      rest.young_modulus = 2.0 * lame.mu;
      rest.poisson_ratio = 0.0;
      const Tet& n = mesh.tets[t];
      const double quarter =
          signedVolume6(mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]], mesh.nodes[n[3]]) /
          24.0;
      for (const Index node : n)
      {
        Mean& mean = means[{node, lame.mu, lame.lambda}];
        mean.volume += quarter;
        mean.dilatation +=
            quarter * dilatationOf(model, deformationOf(mesh, n, x.data() + first_node));
      }
    }
    energy += TetElasticity(one, model, {rest}, first_node).value(x);
  }
  for (const auto& [key, mean] : means)
  {
    energy += mean.volume * std::get<2>(key) * volumeEnergyOf(model, mean.dilatation / mean.volume);
  }
  return energy;
}

}  // namespace soft_tissue::test
