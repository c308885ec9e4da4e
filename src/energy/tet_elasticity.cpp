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
constexpr Index kGroupGrain = 16;  // groups of eight tets per parallel piece
constexpr Index kNodeGrain = 256;
constexpr Index kBlockGrain = 512;
}  // namespace

TetElasticity::TetElasticity(const TetMesh& rest, MaterialModel model,
                             const std::vector<TetStiffnessParameters>& parameters,
                             Index first_node)
    : first_node_(first_node),
      node_count_(static_cast<Index>(rest.nodes.size())),
      tet_count_(static_cast<Index>(rest.tets.size())),
      group_count_((tet_count_ + kTetLanes - 1) / kTetLanes),
      kernels_(&tetKernels(model, instructionSet())),
      tets_(rest.tets)
{
  const std::size_t lanes = static_cast<std::size_t>(group_count_) * kTetLanes;
  // Unused lanes of the last group read the body's first node and weigh nothing.
  group_nodes_.assign(4 * lanes, first_node_);
  group_gradients_.assign(9 * lanes, 0.0);
  group_volumes_.assign(lanes, 0.0);
  group_constants_.assign(kMaterialConstants * lanes, 1.0);
  for (Index t = 0; t < tet_count_; ++t)
  {
    const Tet& tet = rest.tets[t];
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
    {
      edges.col(k) = rest.nodes[tet[k + 1]] - rest.nodes[tet[0]];
    }
    const double volume = edges.determinant() / 6.0;
    const Mat3 gradients = edges.inverse();
    if (!(volume > 0.0) || !gradients.allFinite())
    {
      throw Error("tet " + std::to_string(t) + " has rest volume " + std::to_string(volume) +
                  " m^3, must be > 0; mesh_tool repair removes such tets");
    }
    const std::size_t group = static_cast<std::size_t>(t) / kTetLanes, lane = t % kTetLanes;
    for (int k = 0; k < 4; ++k)
    {
      group_nodes_[8 * (4 * group + k) + lane] = first_node_ + tet[k];
    }
    for (int k = 0; k < 9; ++k)
    {
      group_gradients_[8 * (9 * group + k) + lane] = gradients(k / 3, k % 3);
    }
    group_volumes_[8 * group + lane] = volume;
    double constants[kMaterialConstants];
    kernels_->constants(parameters[t].young_modulus, parameters[t].poisson_ratio, constants);
    for (int k = 0; k < kMaterialConstants; ++k)
    {
      group_constants_[8 * (kMaterialConstants * group + k) + lane] = constants[k];
    }
  }
  groups_ = {group_nodes_.data(), group_gradients_.data(), group_volumes_.data(),
             group_constants_.data()};
  energies_.resize(lanes);
  det_f_.resize(lanes);
  gradients_.resize(12 * lanes);
  stiffness_.resize(kTetStiffnessSize * lanes);
  prepareGathers(rest);
}

void TetElasticity::prepareGathers(const TetMesh& rest)
{
  corners_ = nodeTets(node_count_, rest.tets);
  for (Index node = 0; node < node_count_; ++node)
  {
    for (Index k = corners_.offsets[node]; k < corners_.offsets[node + 1]; ++k)
    {
      const Index t = corners_.items[k];
      const Tet& tet = rest.tets[t];
      corners_.items[k] =
          4 * t + static_cast<Index>(std::find(tet.begin(), tet.end(), node) - tet.begin());
    }
  }
}

void TetElasticity::prepareBlocks(const BlockMatrix& hessian)
{
  struct Contribution
  {
    Index position;
    BlockSource source;
  };
  std::vector<Contribution> all;
  all.reserve(10 * static_cast<std::size_t>(tet_count_));
  for (Index t = 0; t < tet_count_; ++t)
  {
    const Index base = t * kTetStiffnessSize;
    for (int a = 0; a < 4; ++a)
    {
      const Index row = first_node_ + tets_[t][a];
      all.push_back({hessian.diagonal(row), {base + diagonalBlockOffset(a), false}});
      for (int b = a + 1; b < 4; ++b)
      {
        const Index column = first_node_ + tets_[t][b];
        const Index position = hessian.find(std::min(row, column), std::max(row, column));
        all.push_back({position, {base + offDiagonalBlockOffset(a, b), row > column}});
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Contribution& a, const Contribution& b) {
    return a.position < b.position;
  });
  block_position_.clear();
  block_sources_begin_.clear();
  block_sources_.clear();
  for (const Contribution& c : all)
  {
    if (block_position_.empty() || block_position_.back() != c.position)
    {
      block_position_.push_back(c.position);
      block_sources_begin_.push_back(static_cast<Index>(block_sources_.size()));
    }
    block_sources_.push_back(c.source);
  }
  block_sources_begin_.push_back(static_cast<Index>(block_sources_.size()));
  // Rows are contiguous ranges of positions: walk them along to find each block's mirror.
  block_mirror_.resize(block_position_.size());
  Index row = 0;
  for (std::size_t k = 0; k < block_position_.size(); ++k)
  {
    while (hessian.offsets()[row + 1] <= block_position_[k])
    {
      ++row;
    }
    block_mirror_[k] = hessian.find(hessian.columns()[block_position_[k]], row);
  }
  matrix_blocks_ = hessian.columns().size();
}

double TetElasticity::value(const Points& x)
{
  return parallelSum(group_count_, kGroupGrain, [&](Index begin, Index end) {
    kernels_->energy(groups_, begin, end, x.data()->data(), energies_.data());
    double sum = 0.0;
    for (Index k = kTetLanes * begin; k < kTetLanes * end; ++k)
    {
      sum += energies_[k];
    }
    return sum;
  });
}

void TetElasticity::addGradient(const Points& x, Points& gradient)
{
  parallelFor(group_count_, kGroupGrain, [&](Index begin, Index end) {
    kernels_->gradient(groups_, begin, end, x.data()->data(), gradients_.data());
  });
  parallelFor(node_count_, kNodeGrain, [&](Index begin, Index end) {
    for (Index node = begin; node < end; ++node)
    {
      double sum[3] = {0.0, 0.0, 0.0};
      for (const Index* corner = corners_.begin(node); corner != corners_.end(node); ++corner)
      {
        const double* g = gradients_.data() + 3 * static_cast<std::size_t>(*corner);
        sum[0] += g[0];
        sum[1] += g[1];
        sum[2] += g[2];
      }
      gradient[first_node_ + node] += Vec3(sum[0], sum[1], sum[2]);
    }
  });
}

void TetElasticity::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  if (matrix_blocks_ != hessian.columns().size())
  {
    prepareBlocks(hessian);
  }
  const auto stiffness =
      curvature == Curvature::exact ? kernels_->stiffness : kernels_->projected_stiffness;
  parallelFor(group_count_, kGroupGrain, [&](Index begin, Index end) {
    stiffness(groups_, begin, end, x.data()->data(), stiffness_.data());
  });
  parallelFor(static_cast<Index>(block_position_.size()), kBlockGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      const BlockSource* source = block_sources_.data() + block_sources_begin_[k];
      const BlockSource* last = block_sources_.data() + block_sources_begin_[k + 1];
      double* block = hessian.block(block_position_[k]);
      if (block_position_[k] == block_mirror_[k])
      {
        double s[6] = {};
        for (; source != last; ++source)
        {
          const double* v = stiffness_.data() + source->place;
          for (int i = 0; i < 6; ++i)
          {
            s[i] += v[i];
          }
        }
        const double full[9] = {s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]};
        for (int i = 0; i < 9; ++i)
        {
          block[i] += full[i];
        }
        continue;
      }
      double straight[9] = {}, turned[9] = {};
      for (; source != last; ++source)
      {
        double* sum = source->transposed ? turned : straight;
        const double* v = stiffness_.data() + source->place;
        for (int i = 0; i < 9; ++i)
        {
          sum[i] += v[i];
        }
      }
      double* mirror = hessian.block(block_mirror_[k]);
      for (int column = 0; column < 3; ++column)
      {
        for (int row = 0; row < 3; ++row)
        {
          const double v = straight[3 * column + row] + turned[3 * row + column];
          block[3 * column + row] += v;
          mirror[3 * row + column] += v;
        }
      }
    }
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
  for (Index t = 1; t < tet_count_; ++t)
  {
    smallest = std::min(smallest, det_f_[t]);
  }
  return smallest;
}

void TetElasticity::vonMises(const Points& x, std::vector<float>& stress)
{
  von_mises_.resize(det_f_.size());
  state(x, von_mises_.data());
  stress.assign(von_mises_.begin(), von_mises_.begin() + tet_count_);
}

}  // namespace soft_tissue
