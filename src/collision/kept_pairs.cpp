#include "kept_pairs.h"

namespace soft_tissue
{
namespace
{
void spanNodes(const ElementSet& set, Index element, const Vec3* x, Vec3& low, Vec3& high)
{
  const Index* const nodes = set.nodes + static_cast<std::size_t>(element) * set.nodes_each;
  low = high = x[nodes[0]];
  for (int k = 1; k < set.nodes_each; ++k)
  {
    low = low.cwiseMin(x[nodes[k]]);
    high = high.cwiseMax(x[nodes[k]]);
  }
}
}  // namespace

KeptPairs::KeptPairs(const ElementSet& first, const ElementSet& second)
    : first_(first), second_(second), place_of_(first.count, -1)
{}

void KeptPairs::keep(const std::vector<ElementPair>& pairs)
{
  kept_.clear();
  firsts_.clear();
  for (const ElementPair& pair : pairs)
  {
    Index& place = place_of_[pair.first];
    if (place < 0)
    {
      place = static_cast<Index>(firsts_.size());
      firsts_.push_back(pair.first);
    }
    kept_.push_back({pair, place});
  }
  for (const Index element : firsts_)
  {
    place_of_[element] = -1;
  }
  boxes_.resize(firsts_.size());
}

void KeptPairs::select(const Vec3* x_first, const Vec3* x_second, double margin,
                       std::vector<ElementPair>& pairs)
{
  Vec3 low, high;
  for (std::size_t i = 0; i < firsts_.size(); ++i)
  {
    spanNodes(first_, firsts_[i], x_first, low, high);
    boxes_[i] = {{low[0] - margin, low[1] - margin, low[2] - margin, -high[0] - margin,
                  -high[1] - margin, -high[2] - margin}};
  }
  pairs.resize(kept_.size());
  ElementPair* next = pairs.data();
  for (std::size_t i = 0; i < kept_.size();)
  {
    const Index second = kept_[i].pair.second;
    spanNodes(second_, second, x_second, low, high);
    const BoxEnds box = {{-high[0], -high[1], -high[2], low[0], low[1], low[2]}};
    for (; i < kept_.size() && kept_[i].pair.second == second; ++i)
    {
      *next = kept_[i].pair;
      next += overlap(boxes_[kept_[i].box], box) ? 1 : 0;
    }
  }
  pairs.resize(next - pairs.data());
}

}  // namespace soft_tissue
