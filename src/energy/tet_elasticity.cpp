#include "soft_tissue_sim/energy/tet_elasticity.h"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGroupGrain = 32;  // groups of eight tets per parallel piece
/** Nodes of the blocks of a tet, in the order of TetKernels::stiffness. */
constexpr int kBlockRow[kTetBlocks] = {0, 1, 2, 3, 0, 0, 0, 1, 1, 2};
constexpr int kBlockColumn[kTetBlocks] = {0, 1, 2, 3, 1, 2, 3, 2, 3, 3};

/** The same four nodes by number: F is that of any order, and blocks are then above the diagonal.
 */
Tet ascending(Tet tet)
{
  std::sort(tet.begin(), tet.end());
  return tet;
}
}  // namespace

TetElasticity::TetElasticity(const TetMesh& rest, MaterialModel model,
                             const std::vector<TetStiffnessParameters>& parameters,
                             Index first_node)
    : first_node_(first_node),
      kernels_(&tetKernels(model, instructionSet())),
      chunks_(chunkTets(rest)),
      group_count_(static_cast<Index>(chunks_.tets.size()) / kTetLanes)
{
  const std::size_t lanes = chunks_.tets.size();
  nodes_.resize(4 * lanes);
  rest_gradients_.assign(9 * lanes, 0.0);
  volumes_.assign(lanes, 0.0);
  constants_.assign(kMaterialConstants * lanes, 1.0);
  for (std::size_t lane = 0; lane < lanes; ++lane)
  {
    const Index tet = chunks_.tets[lane];
    if (tet >= 0)
    {
      addTet(rest, tet, lane, parameters[tet]);
    }
    // Lanes left over weigh nothing, and read and write where their group does anyway.
    const Tet nodes =
        ascending(rest.tets[tet >= 0 ? tet : chunks_.tets[lane / kTetLanes * kTetLanes]]);
    for (int k = 0; k < 4; ++k)
    {
      nodes_[8 * (4 * (lane / kTetLanes) + k) + lane % kTetLanes] = first_node_ + nodes[k];
    }
  }
  groups_ = {nodes_.data(), rest_gradients_.data(), volumes_.data(), constants_.data()};
  energies_.resize(lanes);
  det_f_.resize(lanes);
}

void TetElasticity::addTet(const TetMesh& rest, Index t, std::size_t lane,
                           const TetStiffnessParameters& parameters)
{
  const Tet tet = ascending(rest.tets[t]);
  Mat3 edges;
  for (int k = 0; k < 3; ++k)
  {
    edges.col(k) = rest.nodes[tet[k + 1]] - rest.nodes[tet[0]];
  }
  const double volume = signedVolume6(rest.nodes[rest.tets[t][0]], rest.nodes[rest.tets[t][1]],
                                      rest.nodes[rest.tets[t][2]], rest.nodes[rest.tets[t][3]]) /
                        6.0;
  const Mat3 gradients = edges.inverse();
  if (!(volume > 0.0) || !gradients.allFinite())
  {
    throw Error("tet " + std::to_string(t) + " has rest volume " + std::to_string(volume) +
                " m^3, must be > 0; mesh_tool repair removes such tets");
  }
  const std::size_t group = lane / kTetLanes, place = lane % kTetLanes;
  for (int k = 0; k < 9; ++k)
  {
    rest_gradients_[8 * (9 * group + k) + place] = gradients(k / 3, k % 3);
  }
  volumes_[lane] = volume;
  double constants[kMaterialConstants];
  kernels_->constants(parameters.young_modulus, parameters.poisson_ratio, constants);
  for (int k = 0; k < kMaterialConstants; ++k)
  {
    constants_[8 * (kMaterialConstants * group + k) + place] = constants[k];
  }
}

void TetElasticity::findPositions(const BlockMatrix& hessian)
{
  positions_.resize(kTetBlocks * chunks_.tets.size());
  for (std::size_t lane = 0; lane < chunks_.tets.size(); ++lane)
  {
    const std::size_t group = lane / kTetLanes, place = lane % kTetLanes;
    const Index* nodes = nodes_.data() + 32 * group + place;
    Index* position = positions_.data() + kTetBlocks * kTetLanes * group + place;
    for (int block = 0; block < kTetBlocks; ++block, position += kTetLanes)
    {
      *position = hessian.find(nodes[8 * kBlockRow[block]], nodes[8 * kBlockColumn[block]]);
    }
  }
  if (*std::min_element(positions_.begin(), positions_.end()) < 0)
  {
    throw Error("the Hessian has no block for two nodes that share a tet");
  }
  matrix_blocks_ = hessian.columns().size();
}

template <typename Body>
void TetElasticity::forGroups(const Body& body) const
{
  for (std::size_t colour = 0; colour + 1 < chunks_.colours.size(); ++colour)
  {
    const Index first = chunks_.colours[colour];
    parallelFor(chunks_.colours[colour + 1] - first, 1, [&](Index begin, Index end) {
      body(chunks_.groups[first + begin], chunks_.groups[first + end]);
    });
  }
}

double TetElasticity::sumOfEnergies(Index begin, Index end) const
{
  double sum = 0.0;
  for (Index k = kTetLanes * begin; k < kTetLanes * end; ++k)
  {
    sum += energies_[k];
  }
  return sum;
}

double TetElasticity::value(const Points& x)
{
  return parallelSum(group_count_, kGroupGrain, [&](Index begin, Index end) {
    kernels_->energy(groups_, begin, end, x.data()->data(), energies_.data());
    return sumOfEnergies(begin, end);
  });
}

void TetElasticity::addGradient(const Points& x, Points& gradient)
{
  forGroups([&](Index begin, Index end) {
    kernels_->gradient(groups_, begin, end, x.data()->data(), gradient.data()->data(),
                       energies_.data());
  });
}

double TetElasticity::valueAndGradient(const Points& x, Points& gradient)
{
  addGradient(x, gradient);
  return parallelSum(group_count_, kGroupGrain,
                     [&](Index begin, Index end) { return sumOfEnergies(begin, end); });
}

void TetElasticity::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  if (matrix_blocks_ != hessian.columns().size())
  {
    findPositions(hessian);
  }
  const auto add =
      curvature == Curvature::exact ? kernels_->stiffness : kernels_->projected_stiffness;
  forGroups([&](Index begin, Index end) {
    add(groups_, begin, end, x.data()->data(), positions_.data(), hessian.values().data());
  });
}

void TetElasticity::state(const Points& x, double* von_mises)
{
  parallelFor(group_count_, kGroupGrain, [&](Index begin, Index end) {
    kernels_->state(groups_, begin, end, x.data()->data(), det_f_.data(), von_mises);
  });
}

double TetElasticity::minDetF(const Points& x)
{
  state(x, nullptr);
  double smallest = det_f_[0];
  for (std::size_t lane = 1; lane < det_f_.size(); ++lane)
  {
    smallest = chunks_.tets[lane] >= 0 ? std::min(smallest, det_f_[lane]) : smallest;
  }
  return smallest;
}

void TetElasticity::vonMises(const Points& x, std::vector<float>& stress)
{
  von_mises_.resize(det_f_.size());
  state(x, von_mises_.data());
  stress.resize(1 + *std::max_element(chunks_.tets.begin(), chunks_.tets.end()));
  for (std::size_t lane = 0; lane < von_mises_.size(); ++lane)
  {
    if (chunks_.tets[lane] >= 0)
    {
      stress[chunks_.tets[lane]] = static_cast<float>(von_mises_[lane]);
    }
  }
}

}  // namespace soft_tissue
