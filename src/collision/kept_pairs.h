#pragma once

#include <vector>

#include "box_kernels.h"

namespace soft_tissue
{
/** Pairs of a search with a wider margin, from which those of later positions are picked. */
class KeptPairs
{
 public:
  KeptPairs(const ElementSet& first, const ElementSet& second);

  /** @param pairs  ascending by second, then by first */
  void keep(const std::vector<ElementPair>& pairs);

  /** Lists the kept pairs whose boxes are no farther apart than a margin; all nodes are finite. m
   */
  void select(const Vec3* x_first, const Vec3* x_second, double margin,
              std::vector<ElementPair>& pairs);

 private:
  ElementSet first_, second_;
  std::vector<BoxedPair> kept_;
  std::vector<Index> firsts_;    ///< the first elements, once each
  std::vector<BoxEnds> boxes_;   ///< theirs
  std::vector<Index> place_of_;  ///< per element of the first set, in firsts_; -1 between calls
};

}  // namespace soft_tissue
