#include <array>

#include "group_pairs.h"
#include "pair_methods.h"

namespace soft_tissue
{
namespace
{
/** A box of each tree. */
struct TreePair
{
  int first_level, second_level;
  Index first, second;
};

/** Goes down both trees at once where their boxes overlap. */
class TreePairs : public GroupPairs
{
 public:
  using GroupPairs::GroupPairs;

 protected:
  void search() override
  {
    // Each turn takes one off and puts at most two on, a level lower: 2^31 elements have 28 levels.
    std::array<TreePair, 64> stack;
    int size = 0;
    stack[size++] = {first_.levels() - 1, second_.levels() - 1, 0, 0};
    while (size > 0)
    {
      const TreePair pair = stack[--size];
      const BoxEnds& a = first_.level(pair.first_level)[pair.first];
      const BoxEnds& b = second_.level(pair.second_level)[pair.second];
      if (!overlap(a, b, slack_))
      {
        continue;
      }
      if (pair.first_level == 0 && pair.second_level == 0)
      {
        join(pair.first, pair.second);
        continue;
      }
      const bool split_first =
          pair.second_level == 0 || (pair.first_level > 0 && edges(a) > edges(b));
      TreePair child = pair;
      int& level = split_first ? child.first_level : child.second_level;
      Index& number = split_first ? child.first : child.second;
      const ElementGroups& split = split_first ? first_ : second_;
      --level;
      number *= 2;
      stack[size++] = child;
      if (++number < static_cast<Index>(split.level(level).size()))
      {
        stack[size++] = child;
      }
    }
  }
};
}  // namespace

std::unique_ptr<PairFinder> makeTreePairs(const ElementSet& first, const ElementSet& second,
                                          bool one_body)
{
  return std::make_unique<TreePairs>(first, second, one_body);
}

}  // namespace soft_tissue
