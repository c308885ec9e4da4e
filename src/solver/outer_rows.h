#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/outer_products.h"

namespace soft_tissue
{
/** Outer products by vectors and by nodes, in one precision, for products without any scatter, and
 * with nodes in another order. */
template <typename Real>
class OuterRows
{
 public:
  /** @param place  of each node in that order */
  void load(const OuterProducts& outer, const std::vector<Index>& place)
  {
    loaded_.clear();
    for (const Index node : outer.nodes())
    {
      loaded_.push_back(place[node]);
    }
    if (offsets_ != outer.offsets() || nodes_ != loaded_ ||
        node_offsets_.size() != place.size() + 1)
    {
      offsets_ = outer.offsets();
      nodes_ = loaded_;
      findByNode(static_cast<Index>(place.size()));
    }
    weights_.assign(outer.weights().begin(), outer.weights().end());
    vectors_.resize(3 * nodes_.size());
    by_node_.resize(vectors_.size());
    products_.resize(weights_.size());
    for (std::size_t place = 0; place < nodes_.size(); ++place)
    {
      const double* from = outer.vector(static_cast<Index>(place));
      for (int k = 0; k < 3; ++k)
      {
        vectors_[3 * place + k] = by_node_[3 * place_by_node_[place] + k] =
            static_cast<Real>(from[k]);
      }
    }
  }

  bool empty() const { return weights_.empty(); }

  /** Block of a node on the diagonal, nine numbers, added in double precision.
   * @param node  its place */
  void addDiagonal(Index node, double* block) const
  {
    for (Index place = node_offsets_[node]; place < node_offsets_[node + 1]; ++place)
    {
      const Real* g = by_node_.data() + 3 * static_cast<std::size_t>(place);
      const double weight = weights_[vector_by_node_[place]];
      for (int k = 0; k < 9; ++k)
      {
        block[k] += weight * g[k % 3] * g[k / 3];
      }
    }
  }

  /** q += G^T D G p for flat vectors, 3 numbers a node. @return p . G^T D G p */
  double addProduct(const Real* p, Real* q)
  {
    constexpr Index kGrain = 128;
    const double sum =
        parallelSum(static_cast<Index>(weights_.size()), kGrain, [&](Index begin, Index end) {
          double squares = 0.0;
          for (Index k = begin; k < end; ++k)
          {
            Real product = 0;
            for (Index place = offsets_[k]; place < offsets_[k + 1]; ++place)
            {
              const Real* g = vectors_.data() + 3 * static_cast<std::size_t>(place);
              const Real* v = p + 3 * static_cast<std::size_t>(nodes_[place]);
              product += g[0] * v[0] + g[1] * v[1] + g[2] * v[2];
            }
            products_[k] = weights_[k] * product;
            squares += static_cast<double>(products_[k]) * product;
          }
          return squares;
        });
    const auto node_count = static_cast<Index>(node_offsets_.size()) - 1;
    parallelFor(node_count, kGrain, [&](Index begin, Index end) {
      for (Index node = begin; node < end; ++node)
      {
        Real x = 0, y = 0, z = 0;
        for (Index place = node_offsets_[node]; place < node_offsets_[node + 1]; ++place)
        {
          const Real* g = by_node_.data() + 3 * static_cast<std::size_t>(place);
          const Real factor = products_[vector_by_node_[place]];
          x += factor * g[0];
          y += factor * g[1];
          z += factor * g[2];
        }
        Real* to = q + 3 * static_cast<std::size_t>(node);
        to[0] += x;
        to[1] += y;
        to[2] += z;
      }
    });
    return sum;
  }

 private:
  void findByNode(Index node_count)
  {
    node_offsets_.assign(node_count + 1, 0);
    for (const Index node : nodes_)
    {
      ++node_offsets_[node + 1];
    }
    for (Index node = 0; node < node_count; ++node)
    {
      node_offsets_[node + 1] += node_offsets_[node];
    }
    std::vector<Index> next(node_offsets_.begin(), node_offsets_.end() - 1);
    place_by_node_.resize(nodes_.size());
    vector_by_node_.resize(nodes_.size());
    for (std::size_t k = 0; k + 1 < offsets_.size(); ++k)
    {
      for (Index place = offsets_[k]; place < offsets_[k + 1]; ++place)
      {
        place_by_node_[place] = next[nodes_[place]]++;
        vector_by_node_[place_by_node_[place]] = static_cast<Index>(k);
      }
    }
  }

  std::vector<Index> offsets_, nodes_;  ///< the pattern loaded last
  std::vector<Index> loaded_;           ///< nodes of the last load()
  std::vector<Index> node_offsets_;     ///< of nodes in the arrays by node
  std::vector<Index> place_by_node_;    ///< per place among the vectors: that among the nodes
  std::vector<Index> vector_by_node_;   ///< per place among the nodes
  std::vector<Real> vectors_, by_node_;
  std::vector<Real> weights_, products_;
};

}  // namespace soft_tissue
