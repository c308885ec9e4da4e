#include "soft_tissue_sim/collision/pair_finder.h"

#include "pair_methods.h"

namespace soft_tissue
{
std::unique_ptr<PairFinder> makePairFinder(PairMethod method, const ElementSet& first,
                                           const ElementSet& second, bool one_body)
{
  switch (method)
  {
    case PairMethod::hash:
      return makeHashPairs(first, second, one_body);
    case PairMethod::sweep:
      return makeSweepPairs(first, second, one_body);
    case PairMethod::tree:
      break;
  }
  return makeTreePairs(first, second, one_body);
}

}  // namespace soft_tissue
