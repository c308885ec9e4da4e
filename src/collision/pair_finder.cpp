#include "soft_tissue_sim/collision/pair_finder.h"

#include <algorithm>

#include "soft_tissue_sim/collision/box_grid.h"

namespace soft_tissue
{
namespace
{
Box3 boxOf(const ElementSet& set, Index element, const Vec3* x)
{
  Box3 box;
  for (int k = 0; k < set.nodes_each; ++k)
  {
    box.extend(x[set.nodes[element * set.nodes_each + k]]);
  }
  return box;
}

class HashPairs : public PairFinder
{
 public:
  HashPairs(const ElementSet& first, const ElementSet& second, bool one_body)
      : first_(first), second_(second), one_body_(one_body)
  {}

  void find(const Vec3* x_first, const Vec3* x_second, double margin,
            std::vector<ElementPair>& pairs) override
  {
    pairs.clear();
    boxes_.resize(first_.count);
    for (Index i = 0; i < first_.count; ++i)
    {
      boxes_[i] = boxOf(first_, i, x_first);
      boxes_[i].grow(margin);
    }
    grid_.build(boxes_);
    for (Index j = 0; j < second_.count; ++j)
    {
      const std::size_t begin = pairs.size();
      grid_.forEachOverlap(boxOf(second_, j, x_second), [&](Index i) {
        if (!(one_body_ && shareNode(i, j)))
        {
          pairs.push_back({i, j});
        }
      });
      std::sort(pairs.begin() + begin, pairs.end(),
                [](const ElementPair& a, const ElementPair& b) { return a.first < b.first; });
    }
  }

 private:
  bool shareNode(Index i, Index j) const
  {
    const Index* a = first_.nodes + i * first_.nodes_each;
    const Index* b = second_.nodes + j * second_.nodes_each;
    return std::any_of(a, a + first_.nodes_each, [&](Index node) {
      return std::find(b, b + second_.nodes_each, node) != b + second_.nodes_each;
    });
  }

  ElementSet first_, second_;
  bool one_body_;
  std::vector<Box3> boxes_;
  BoxGrid grid_;
};
}  // namespace

std::unique_ptr<PairFinder> makePairFinder(PairMethod, const ElementSet& first,
                                           const ElementSet& second, bool one_body)
{
  return std::make_unique<HashPairs>(first, second, one_body);
}

}  // namespace soft_tissue
