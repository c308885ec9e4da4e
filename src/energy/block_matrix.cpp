#include "soft_tissue_sim/energy/block_matrix.h"

#include <algorithm>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
BlockMatrix::BlockMatrix(const Adjacency& neighbours)
{
  const Index rows = neighbours.size();
  offsets_.reserve(rows + 1);
  columns_.reserve(neighbours.items.size() + rows);
  diagonal_.reserve(rows);
  offsets_.push_back(0);
  for (Index row = 0; row < rows; ++row)
  {
    const Index* after = std::lower_bound(neighbours.begin(row), neighbours.end(row), row);
    columns_.insert(columns_.end(), neighbours.begin(row), after);
    diagonal_.push_back(static_cast<Index>(columns_.size()));
    columns_.push_back(row);
    columns_.insert(columns_.end(), after, neighbours.end(row));
    offsets_.push_back(static_cast<Index>(columns_.size()));
  }
  values_.assign(9 * columns_.size() + 3, 0.0);
  row_coupling_.assign(rows, -1);
  // Rows ascend, so the blocks above the diagonal of a column come in the order of their rows: the
  // order in which that column's row has its blocks below the diagonal.
  mirror_.resize(columns_.size());
  std::vector<Index> next(offsets_.begin(), offsets_.end() - 1);
  for (Index row = 0; row < rows; ++row)
  {
    for (Index k = diagonal_[row]; k < offsets_[row + 1]; ++k)
    {
      mirror_[next[columns_[k]]++] = k;
    }
  }
}

void BlockMatrix::setZero()
{
  constexpr Index kGrain = 2048;
  parallelFor(static_cast<Index>(values_.size()), kGrain, [&](Index begin, Index end) {
    std::fill(values_.begin() + begin, values_.begin() + end, 0.0);
  });
  for (const Coupling& coupling : couplings_)
  {
    row_coupling_[coupling.row] = -1;
  }
  couplings_.clear();
  next_coupling_.clear();
  outer_.clear();
}

Index BlockMatrix::find(Index row, Index column) const
{
  const auto begin = columns_.begin() + offsets_[row];
  const auto end = columns_.begin() + offsets_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found != end && *found == column ? static_cast<Index>(found - columns_.begin()) : -1;
}

void BlockMatrix::add(Index row, Index column, const Mat3& b)
{
  if (row > column)
  {
    throw Error("block (" + std::to_string(row) + ", " + std::to_string(column) +
                ") is below the diagonal");
  }
  const Index position = find(row, column);
  if (position >= 0)
  {
    Eigen::Map<Mat3>(block(position)) += b;
    return;
  }
  for (Index i = row_coupling_[row]; i >= 0; i = next_coupling_[i])
  {
    if (couplings_[i].column == column)
    {
      couplings_[i].block += b;
      return;
    }
  }
  next_coupling_.push_back(row_coupling_[row]);
  row_coupling_[row] = static_cast<Index>(couplings_.size());
  couplings_.push_back({row, column, b});
}

}  // namespace soft_tissue
