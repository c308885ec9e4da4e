#include "kept_pairs.h"

namespace soft_tissue
{
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
  const BoxKernels& kernels = boxKernels(instructionSet());
  kernels.boxes(first_, x_first, margin, firsts_.data(), static_cast<Index>(firsts_.size()),
                boxes_.data());
  pairs.resize(kept_.size());
  pairs.resize(kernels.pick(kept_.data(), static_cast<Index>(kept_.size()), boxes_.data(), second_,
                            x_second, pairs.data()));
}

}  // namespace soft_tissue
