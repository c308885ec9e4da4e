#include "soft_tissue_sim/collision/segment_cover.h"

#include <algorithm>
#include <cstddef>

namespace soft_tissue
{
void SegmentCover::reset(Index segment_count)
{
  head_.assign(segment_count, -1);
  pieces_.clear();
}

void SegmentCover::add(Index segment, Index host, const Interval& where)
{
  pieces_.push_back({{where, host}, head_[segment]});
  head_[segment] = static_cast<Index>(pieces_.size()) - 1;
}

const std::vector<SegmentPiece>& SegmentCover::disjointPieces(Index segment)
{
  row_.clear();
  for (Index i = head_[segment]; i >= 0; i = pieces_[i].next)
  {
    row_.push_back(pieces_[i].piece);
  }
  std::sort(row_.begin(), row_.end(), [](const SegmentPiece& a, const SegmentPiece& b) {
    return a.where.begin != b.where.begin ? a.where.begin < b.where.begin : a.host < b.host;
  });
  std::size_t kept = 0;
  double covered = 0.0;
  for (SegmentPiece piece : row_)
  {
    piece.where.begin = std::max(piece.where.begin, covered);
    if (piece.where.begin < piece.where.end)
    {
      covered = piece.where.end;
      row_[kept++] = piece;
    }
  }
  row_.resize(kept);
  return row_;
}

}  // namespace soft_tissue
