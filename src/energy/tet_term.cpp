#include "soft_tissue_sim/energy/tet_term.h"

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
TetTerm::TetTerm(const TetKernels& kernels, const TetMesh& rest, const std::vector<Index>& stencils,
                 Index first_node)
    : kernels_(&kernels),
      chunks_(chunkTets(rest)),
      group_count_(static_cast<Index>(chunks_.tets.size()) / kTetLanes)
{
  const std::size_t lanes = chunks_.tets.size();
  const auto count = static_cast<std::size_t>(kernels.nodes);
  nodes_.resize(count * lanes);
  rest_gradients_.assign(9 * lanes, 0.0);
  volumes_.assign(lanes, 0.0);
  constants_.assign(kernels.constants_each * lanes, 1.0);
  for (std::size_t lane = 0; lane < lanes; ++lane)
  {
    const std::size_t group = lane / kTetLanes;
    const Index tet = chunks_.tets[lane];
    // Lanes left over weigh nothing, and read and write where their group does anyway.
    const Index* stencil = &stencils[count * (tet >= 0 ? tet : chunks_.tets[group * kTetLanes])];
    if (tet >= 0)
    {
      addTet(rest, tet, stencil, lane);
    }
    for (std::size_t k = 0; k < count; ++k)
    {
      nodes_[8 * (count * group + k) + lane % kTetLanes] = first_node + stencil[k];
    }
  }
  groups_ = {nodes_.data(), rest_gradients_.data(), volumes_.data(), constants_.data(), nullptr};
  energies_.resize(lanes);
}

TetTerm::TetTerm(const TetKernels& kernels, const TetTerm& tets)
    : kernels_(&kernels),
      chunks_(tets.chunks_),
      group_count_(tets.group_count_),
      nodes_(tets.nodes_),
      rest_gradients_(tets.rest_gradients_),
      volumes_(tets.volumes_),
      constants_(kernels.constants_each * chunks_.tets.size(), 0.0),
      groups_({nodes_.data(), rest_gradients_.data(), volumes_.data(), constants_.data(), nullptr}),
      energies_(chunks_.tets.size())
{}

void TetTerm::addTet(const TetMesh& rest, Index t, const Index* vertices, std::size_t lane)
{
  Mat3 edges;
  for (int k = 0; k < 3; ++k)
  {
    edges.col(k) = rest.nodes[vertices[k + 1]] - rest.nodes[vertices[0]];
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
}

void TetTerm::setVolumes(const std::vector<double>& volumes, double factor)
{
  volume_factor_ = factor;
  for (std::size_t lane = 0; lane < volumes.size(); ++lane)
  {
    volumes_[lane] = factor * volumes[lane];
  }
}

void TetTerm::remember(const Points& x, std::vector<double>& six)
{
  prepare(x);
  six.resize(6 * static_cast<std::size_t>(kernels_->points) * chunks_.tets.size());
  parallelFor(group_count_, kGroupGrain, [&](Index begin, Index end) {
    kernels_->remember(groups_, begin, end, x.data()->data(), six.data());
  });
}

void TetTerm::setPlaces(const std::vector<double>& places)
{
  const std::size_t count = 4 * static_cast<std::size_t>(kernels_->parts);
  places_.assign(count * chunks_.tets.size(), 0.0);
  for (std::size_t lane = 0; lane < chunks_.tets.size(); ++lane)
  {
    const Index tet = chunks_.tets[lane];
    for (std::size_t k = 0; k < count && tet >= 0; ++k)
    {
      places_[8 * (count * (lane / kTetLanes) + k) + lane % kTetLanes] = places[count * tet + k];
    }
  }
  groups_.places = places_.data();
}

void TetTerm::findPositions(const BlockMatrix& hessian)
{
  const auto nodes = static_cast<std::size_t>(kernels_->nodes);
  const auto blocks = static_cast<std::size_t>(kernels_->block_count);
  positions_.resize(blocks * chunks_.tets.size());
  for (std::size_t lane = 0; lane < chunks_.tets.size(); ++lane)
  {
    const std::size_t group = lane / kTetLanes, place = lane % kTetLanes;
    const Index* node = nodes_.data() + kTetLanes * nodes * group + place;
    Index* position = positions_.data() + kTetLanes * blocks * group + place;
    for (std::size_t k = 0; k < blocks; ++k)
    {
      const BlockNodes& block = kernels_->blocks[k];
      position[kTetLanes * k] =
          hessian.find(node[kTetLanes * block[0]], node[kTetLanes * block[1]]);
    }
  }
  if (*std::min_element(positions_.begin(), positions_.end()) < 0)
  {
    throw Error("the Hessian has no block for two nodes that share a tet");
  }
  matrix_blocks_ = hessian.columns().size();
}

template <typename Body>
void TetTerm::forGroups(const Body& body) const
{
  for (std::size_t colour = 0; colour + 1 < chunks_.colours.size(); ++colour)
  {
    const Index first = chunks_.colours[colour];
    parallelFor(chunks_.colours[colour + 1] - first, 1, [&](Index begin, Index end) {
      body(chunks_.groups[first + begin], chunks_.groups[first + end]);
    });
  }
}

double TetTerm::sumOfEnergies(Index begin, Index end) const
{
  double sum = 0.0;
  for (Index k = kTetLanes * begin; k < kTetLanes * end; ++k)
  {
    sum += energies_[k];
  }
  return sum;
}

double TetTerm::value(const Points& x)
{
  const double shared = prepare(x);
  return shared + parallelSum(group_count_, kGroupGrain, [&](Index begin, Index end) {
           kernels_->energy(groups_, begin, end, x.data()->data(), energies_.data());
           return sumOfEnergies(begin, end);
         });
}

void TetTerm::addForces(const Points& x, Points& gradient)
{
  forGroups([&](Index begin, Index end) {
    kernels_->gradient(groups_, begin, end, x.data()->data(), gradient.data()->data(),
                       energies_.data());
  });
}

void TetTerm::addGradient(const Points& x, Points& gradient)
{
  prepare(x);
  addForces(x, gradient);
}

double TetTerm::valueAndGradient(const Points& x, Points& gradient)
{
  const double shared = prepare(x);
  addForces(x, gradient);
  return shared + parallelSum(group_count_, kGroupGrain,
                              [&](Index begin, Index end) { return sumOfEnergies(begin, end); });
}

void TetTerm::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  // A matrix whose pattern differs elsewhere has this body's blocks moved as one.
  const BlockNodes& first = kernels_->blocks[0];
  if (matrix_blocks_ != hessian.columns().size() ||
      positions_.front() !=
          hessian.find(nodes_[kTetLanes * first[0]], nodes_[kTetLanes * first[1]]))
  {
    findPositions(hessian);
  }
  prepare(x);
  const auto add =
      curvature == Curvature::exact ? kernels_->stiffness : kernels_->projected_stiffness;
  forGroups([&](Index begin, Index end) {
    add(groups_, begin, end, x.data()->data(), positions_.data(), hessian.values().data());
  });
}

}  // namespace soft_tissue
