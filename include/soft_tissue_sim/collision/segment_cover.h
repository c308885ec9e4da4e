#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/collision/interval.h"

namespace soft_tissue
{
/** A stretch of a segment that lies in one tet. */
struct SegmentPiece
{
  Interval where;
  Index host = -1;  ///< whatever number the tet was added under
};

/**
 * Collects, for many segments, the tets each passes through, and gives every point to one tet only.
 *
 * A segment in a shared face, or where deformed tets overlap, is inside several: the stretch goes
 * to the one that begins first, then to the smaller number.
 */
class SegmentCover
{
 public:
  void reset(Index segment_count);
  void add(Index segment, Index host, const Interval& where);
  bool empty() const { return pieces_.empty(); }

  /** Disjoint pieces of one segment in ascending order; valid until the next call. */
  const std::vector<SegmentPiece>& disjointPieces(Index segment);

 private:
  struct Link
  {
    SegmentPiece piece;
    Index next;
  };
  std::vector<Index> head_;  ///< per segment its first link, or -1
  std::vector<Link> pieces_;
  std::vector<SegmentPiece> row_;
};

}  // namespace soft_tissue
