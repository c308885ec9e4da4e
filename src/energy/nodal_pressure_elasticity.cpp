#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"

#include <algorithm>
#include <tuple>

#include "soft_tissue_sim/base/parallel.h"
#include "tet_nodes.h"

namespace soft_tissue
{
namespace
{
constexpr Index kMeanGrain = 32;  ///< groups of eight means per parallel piece

/** A tet's corner at a node, and what is stiff there. */
struct Place
{
  Index node;
  Lame lame;
  Index corner;

  bool sameMean(const Place& other) const
  {
    return node == other.node && lame.mu == other.lame.mu && lame.lambda == other.lame.lambda;
  }
  bool operator<(const Place& other) const
  {
    return std::tie(node, lame.mu, lame.lambda, corner) <
           std::tie(other.node, other.lame.mu, other.lame.lambda, other.corner);
  }
};
}  // namespace

NodalPressureElasticity::NodalPressureElasticity(
    const TetMesh& rest, MaterialModel model, const std::vector<TetStiffnessParameters>& parameters,
    Index first_node)
    : Elasticity(pressedTetKernels(model, instructionSet()), rest, ascendingNodes(rest.tets),
                 parameters, first_node),
      rest_volumes_(volumes())
{
  findMeans(parameters);
  findNodes();
  dilatations_.resize(tets().size());
  gradients_.resize(12 * tets().size());
  const auto padded = static_cast<std::size_t>((mean_count_ + kTetLanes) / kTetLanes * kTetLanes);
  for (std::vector<double>* all : {&means_, &energies_, &slopes_, &curvatures_})
  {
    all->assign(padded, 0.0);
  }
}

void NodalPressureElasticity::findMeans(const std::vector<TetStiffnessParameters>& parameters)
{
  std::vector<Place> places;
  for (Index lane = 0; lane < static_cast<Index>(tets().size()); ++lane)
  {
    const Index tet = tets()[lane];
    for (int corner = 0; corner < 4 && tet >= 0; ++corner)
    {
      const Lame lame = lameFrom(parameters[tet].young_modulus, parameters[tet].poisson_ratio);
      if (lame.lambda > 0.0)
      {
        places.push_back({nodeOf(lane, corner), lame, 4 * lane + corner});
      }
    }
  }
  std::sort(places.begin(), places.end());
  corners_.offsets = {0};
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    if (k == 0 || !places[k].sameMean(places[k - 1]))
    {
      mean_lambdas_.push_back(places[k].lame.lambda);
      mean_volumes_.push_back(0.0);
      corners_.offsets.push_back(corners_.offsets.back());
    }
    mean_volumes_.back() += 0.25 * rest_volumes_[places[k].corner / 4];
    corners_.items.push_back(places[k].corner);
    ++corners_.offsets.back();
  }
  mean_count_ = corners_.size();
  mean_of_.assign(4 * tets().size(), mean_count_);
  for (Index mean = 0; mean < mean_count_; ++mean)
  {
    for (const Index* corner = corners_.begin(mean); corner != corners_.end(mean); ++corner)
    {
      mean_of_[*corner] = mean;
    }
  }
}

void NodalPressureElasticity::findNodes()
{
  nodes_.offsets = {0};
  slots_.resize(4 * corners_.items.size());
  std::vector<Index> nodes;
  for (Index mean = 0; mean < mean_count_; ++mean)
  {
    nodes.clear();
    for (const Index* corner = corners_.begin(mean); corner != corners_.end(mean); ++corner)
    {
      for (int k = 0; k < 4; ++k)
      {
        nodes.push_back(nodeOf(*corner / 4, k));
      }
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (Index item = corners_.offsets[mean]; item < corners_.offsets[mean + 1]; ++item)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Index node = nodeOf(corners_.items[item] / 4, k);
        slots_[4 * item + k] =
            static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
      }
    }
    nodes_.items.insert(nodes_.items.end(), nodes.begin(), nodes.end());
    nodes_.offsets.push_back(static_cast<Index>(nodes_.items.size()));
  }
}

/** means_, and what U makes of them. */
void NodalPressureElasticity::takeMeans(const Points& x)
{
  const DilatationKernels& loops = *kernels().dilatation;
  parallelFor(groupCount(), kGroupGrain, [&](Index begin, Index end) {
    loops.dilatation(groups(), begin, end, x.data()->data(), dilatations_.data());
  });
  const auto mean_groups = static_cast<Index>(means_.size()) / kTetLanes;
  parallelFor(mean_groups, kMeanGrain, [&](Index begin, Index end) {
    for (Index mean = kTetLanes * begin; mean < std::min(kTetLanes * end, mean_count_); ++mean)
    {
      double sum = 0.0;
      for (const Index* corner = corners_.begin(mean); corner != corners_.end(mean); ++corner)
      {
        sum += 0.25 * rest_volumes_[*corner / 4] * dilatations_[*corner / 4];
      }
      means_[mean] = sum / mean_volumes_[mean];
    }
    loops.energy(begin, end, means_.data(), energies_.data(), slopes_.data(), curvatures_.data());
  });
}

/** Each tet the mean of its nodes' pressures. */
void NodalPressureElasticity::givePressures()
{
  for (std::size_t k = mean_count_; k < slopes_.size(); ++k)
  {
    slopes_[k] = 0.0;  // what corners without a mean read
  }
  parallelFor(groupCount(), kGroupGrain, [&](Index begin, Index end) {
    for (Index lane = kTetLanes * begin; lane < kTetLanes * end; ++lane)
    {
      const Index* means = mean_of_.data() + 4 * lane;
      const double slope =
          0.25 * (slopes_[means[0]] + slopes_[means[1]] + slopes_[means[2]] + slopes_[means[3]]);
      const double lambda = means[0] < mean_count_ ? mean_lambdas_[means[0]] : 0.0;
      constants()[kTetLanes * ((kMaterialConstants + 1) * (lane / kTetLanes) + kMaterialConstants) +
                  lane % kTetLanes] = lambda * slope;
    }
  });
}

double NodalPressureElasticity::prepare(const Points& x)
{
  takeMeans(x);
  givePressures();
  return volumeFactor() *
         parallelSum(mean_count_, kTetLanes * kMeanGrain, [&](Index begin, Index end) {
           double sum = 0.0;
           for (Index mean = begin; mean < end; ++mean)
           {
             sum += mean_volumes_[mean] * mean_lambdas_[mean] * energies_[mean];
           }
           return sum;
         });
}

void NodalPressureElasticity::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  Elasticity::addHessian(x, curvature, hessian);
  parallelFor(groupCount(), kGroupGrain, [&](Index begin, Index end) {
    kernels().dilatation->gradient(groups(), begin, end, x.data()->data(), gradients_.data());
  });
  OuterProducts& outer = hessian.outer();
  const Index first = outer.append(nodes_);
  parallelFor(mean_count_, kTetLanes * kMeanGrain, [&](Index begin, Index end) {
    for (Index mean = begin; mean < end; ++mean)
    {
      double* vector = outer.vector(outer.offsets()[first + mean]);
      const double share = 0.25 / (volumeFactor() * mean_volumes_[mean]);
      for (Index item = corners_.offsets[mean]; item < corners_.offsets[mean + 1]; ++item)
      {
        const Index lane = corners_.items[item] / 4;
        const double* from =
            gradients_.data() + 12 * kTetLanes * (lane / kTetLanes) + lane % kTetLanes;
        for (int k = 0; k < 12; ++k)
        {
          vector[3 * slots_[4 * item + k / 3] + k % 3] += share * from[kTetLanes * k];
        }
      }
      const double weight =
          volumeFactor() * mean_volumes_[mean] * mean_lambdas_[mean] * curvatures_[mean];
      outer.weights()[first + mean] =
          curvature == Curvature::exact ? weight : std::max(weight, 0.0);
    }
  });
}

}  // namespace soft_tissue
