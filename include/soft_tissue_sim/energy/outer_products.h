#pragma once

#include <vector>

#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/**
 * A sum of matrices weight g g^T, each of a sparse vector g that has three numbers at each of its
 * nodes: G^T D G, never multiplied out. What an energy of a mean over many elements adds to the
 * stiffness: g g^T couples all of their nodes.
 */
class OuterProducts
{
 public:
  void clear()
  {
    offsets_.resize(1);
    nodes_.clear();
    vectors_.clear();
    weights_.clear();
  }

  /**
   * Adds vectors with these nodes, all numbers zero.
   * @param nodes  of each vector, ascending
   * @return the number of the first
   */
  Index append(const Adjacency& nodes)
  {
    const Index first = size(), begin = offsets_.back();
    for (Index k = 0; k < nodes.size(); ++k)
    {
      offsets_.push_back(begin + nodes.offsets[k + 1]);
    }
    nodes_.insert(nodes_.end(), nodes.items.begin(), nodes.items.end());
    vectors_.resize(3 * nodes_.size(), 0.0);
    weights_.resize(offsets_.size() - 1, 0.0);
    return first;
  }

  Index size() const { return static_cast<Index>(weights_.size()); }
  bool empty() const { return weights_.empty(); }

  /** The nodes of vector k are nodes()[offsets()[k]] ... nodes()[offsets()[k + 1] - 1]. */
  const std::vector<Index>& offsets() const { return offsets_; }
  const std::vector<Index>& nodes() const { return nodes_; }
  /** Three numbers for each of these. */
  double* vector(Index place) { return vectors_.data() + 3 * static_cast<std::size_t>(place); }
  const double* vector(Index place) const
  {
    return vectors_.data() + 3 * static_cast<std::size_t>(place);
  }
  std::vector<double>& weights() { return weights_; }

  /** Writes, or reads, all. */
  void exchange(StateArchive& archive)
  {
    archive.list(offsets_);
    archive.list(nodes_);
    archive.list(vectors_);
    archive.list(weights_);
  }
  const std::vector<double>& weights() const { return weights_; }

 private:
  std::vector<Index> offsets_ = {0};
  std::vector<Index> nodes_;
  std::vector<double> vectors_;
  std::vector<double> weights_;
};

}  // namespace soft_tissue
