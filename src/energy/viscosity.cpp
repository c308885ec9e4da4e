#include "soft_tissue_sim/energy/viscosity.h"

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
namespace
{
constexpr int kSix = 6 * kTetLanes;  ///< numbers of a point of eight tets
/** Where its strain and its stress stand among the constants of StrainMemory. */
constexpr int kStrainAt = 2 * kTetLanes;
constexpr int kStressAt = 8 * kTetLanes;
constexpr Index kGrain = 64;
}  // namespace

Viscosity::Viscosity(Elasticity& law, const std::vector<TetStiffnessParameters>& parameters,
                     ViscosityParameters viscosity)
    : TetTerm(*law.kernels().memory, law), law_(law), viscosity_(std::move(viscosity))
{
  const std::size_t branches = viscosity_.relaxation.size();
  decays_.resize(branches);
  shares_.resize(branches);
  const std::size_t size = kSix * static_cast<std::size_t>(kernels().points) * groupCount();
  memory_.assign(branches > 0 ? (branches + 1) * size : 0, 0.0);
  lame_.assign(2 * tets().size(), 0.0);
  for (std::size_t lane = 0; lane < tets().size(); ++lane)
  {
    const Index tet = tets()[lane];
    const std::size_t at = 2 * kTetLanes * (lane / kTetLanes) + lane % kTetLanes;
    if (tet >= 0)
    {
      const Lame lame = lameFrom(parameters[tet].young_modulus, parameters[tet].poisson_ratio);
      lame_[at] = viscosity_.stiffness_damping * lame.mu;
      lame_[at + kTetLanes] = viscosity_.stiffness_damping * law_.ownLambda(lame.lambda);
    }
  }
}

void Viscosity::beginStep(const Points& x, double step)
{
  if (viscosity_.stiffness_damping > 0.0)
  {
    setDamping(x, step);
  }
  if (!viscosity_.relaxation.empty())
  {
    setRelaxation(step);
  }
}

void Viscosity::setDamping(const Points& x, double step)
{
  remember(x, strain_);
  const int points = kernels().points;
  parallelFor(groupCount() * points, kGrain, [&](Index begin, Index end) {
    for (Index place = begin; place < end; ++place)
    {
      double* to = constants().data() + kMemoryConstants * kTetLanes * static_cast<long>(place);
      const double* lame = lame_.data() + 2 * kTetLanes * static_cast<long>(place / points);
      const double* strain = strain_.data() + kSix * static_cast<long>(place);
      for (int k = 0; k < kStrainAt; ++k)
      {
        to[k] = lame[k] / step;
      }
      std::copy_n(strain, kSix, to + kStrainAt);
    }
  });
}

void Viscosity::setRelaxation(double step)
{
  double stiffer = 1.0, shares = 0.0;
  for (std::size_t branch = 0; branch < decays_.size(); ++branch)
  {
    const RelaxationBranch& b = viscosity_.relaxation[branch];
    const double steps = step / b.relaxation_time;
    decays_[branch] = std::exp(-steps);
    shares_[branch] = b.relative_modulus * -std::expm1(-steps) / steps;
    shares += shares_[branch];
  }
  stiffer += shares;
  law_.setVolumes(volumes(), stiffer);
  const std::size_t size = memory_.size() / (decays_.size() + 1);
  parallelFor(groupCount() * kernels().points, kGrain, [&](Index begin, Index end) {
    for (Index place = begin; place < end; ++place)
    {
      double* to =
          constants().data() + kMemoryConstants * kTetLanes * static_cast<long>(place) + kStressAt;
      const double* from = memory_.data() + kSix * static_cast<long>(place);
      const double* law = from + size * decays_.size();
      for (int k = 0; k < kSix; ++k)
      {
        to[k] = -shares * law[k];
        for (std::size_t branch = 0; branch < decays_.size(); ++branch)
        {
          to[k] += decays_[branch] * from[size * branch + k];
        }
      }
    }
  });
}

void Viscosity::endStep(const Points& x)
{
  if (viscosity_.relaxation.empty())
  {
    return;
  }
  law_.remember(x, stress_);
  const std::size_t size = stress_.size();
  parallelFor(groupCount() * kernels().points, kGrain, [&](Index begin, Index end) {
    for (std::size_t k = kSix * static_cast<std::size_t>(begin);
         k < kSix * static_cast<std::size_t>(end); ++k)
    {
      double& law = memory_[size * decays_.size() + k];
      const double change = stress_[k] - law;
      for (std::size_t branch = 0; branch < decays_.size(); ++branch)
      {
        double& h = memory_[size * branch + k];
        h = decays_[branch] * h + shares_[branch] * change;
      }
      law = stress_[k];
    }
  });
}

void Viscosity::forget()
{
  std::fill(memory_.begin(), memory_.end(), 0.0);
}

}  // namespace soft_tissue
