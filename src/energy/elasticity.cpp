#include "soft_tissue_sim/energy/elasticity.h"

#include <algorithm>

#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
Elasticity::Elasticity(const TetKernels& kernels, const TetMesh& rest,
                       const std::vector<Index>& stencils,
                       const std::vector<TetStiffnessParameters>& parameters, Index first_node)
    : TetTerm(kernels, rest, stencils, first_node), det_f_(tets().size())
{
  for (std::size_t lane = 0; lane < tets().size(); ++lane)
  {
    const Index tet = tets()[lane];
    if (tet >= 0)
    {
      const Lame lame = lameFrom(parameters[tet].young_modulus, parameters[tet].poisson_ratio);
      double of_tet[kMaterialConstants];
      kernels.constants({lame.mu, ownLambda(lame.lambda), parameters[tet].stiffening}, of_tet);
      for (int k = 0; k < kMaterialConstants; ++k)
      {
        constants()[8 * (kernels.constants_each * (lane / kTetLanes) + k) + lane % kTetLanes] =
            of_tet[k];
      }
    }
  }
}

void Elasticity::state(const Points& x, double* von_mises)
{
  parallelFor(groupCount(), kGroupGrain, [&](Index begin, Index end) {
    kernels().state(groups(), begin, end, x.data()->data(), det_f_.data(), von_mises);
  });
}

double Elasticity::minDetF(const Points& x)
{
  state(x, nullptr);
  double smallest = det_f_[0];
  for (std::size_t lane = 1; lane < det_f_.size(); ++lane)
  {
    smallest = tets()[lane] >= 0 ? std::min(smallest, det_f_[lane]) : smallest;
  }
  return smallest;
}

void Elasticity::vonMises(const Points& x, std::vector<float>& stress)
{
  const auto parts = static_cast<std::size_t>(kernels().parts);
  von_mises_.resize(parts * det_f_.size());
  prepare(x);
  state(x, von_mises_.data());
  stress.resize(parts * (1 + *std::max_element(tets().begin(), tets().end())));
  for (std::size_t lane = 0; lane < det_f_.size(); ++lane)
  {
    const Index tet = tets()[lane];
    for (std::size_t part = 0; part < parts && tet >= 0; ++part)
    {
      stress[parts * tet + part] = static_cast<float>(
          von_mises_[kTetLanes * (parts * (lane / kTetLanes) + part) + lane % kTetLanes]);
    }
  }
}

}  // namespace soft_tissue
