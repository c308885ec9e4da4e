#pragma once

#include <memory>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
std::unique_ptr<PairFinder> makeTreePairs(const ElementSet& first, const ElementSet& second,
                                          bool one_body);
std::unique_ptr<PairFinder> makeHashPairs(const ElementSet& first, const ElementSet& second,
                                          bool one_body);
std::unique_ptr<PairFinder> makeSweepPairs(const ElementSet& first, const ElementSet& second,
                                           bool one_body);

}  // namespace soft_tissue
