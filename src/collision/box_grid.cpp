#include "soft_tissue_sim/collision/box_grid.h"

#include <cmath>

namespace soft_tissue
{
namespace
{
constexpr int kMaxCellsPerAxis = 32;
}

int BoxGrid::cellNumber(const Box3& box) const
{
  const std::array<int, 3> cell = cellOf(0.5 * (box.min + box.max));
  return (cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0];
}

void BoxGrid::build(const std::vector<Box3>& boxes)
{
  bounds_ = Box3();
  half_extent_.setZero();
  for (const Box3& box : boxes)
  {
    bounds_.extend(box.min);
    bounds_.extend(box.max);
    half_extent_ = half_extent_.cwiseMax(0.5 * (box.max - box.min));
  }
  // About as many cells as boxes on a surface: cells of twice the bounds' share of one box.
  const Vec3 size = (bounds_.max - bounds_.min).cwiseMax(0.0);
  const double cell = boxes.empty() ? 0.0 : 2.0 * size.maxCoeff() / std::sqrt(double(boxes.size()));
  for (int axis = 0; axis < 3; ++axis)
  {
    const double wanted = cell > 0.0 ? size[axis] / cell : 1.0;
    cells_[axis] = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, double(kMaxCellsPerAxis)));
    cells_per_metre_[axis] = size[axis] > 0.0 ? cells_[axis] / size[axis] : 0.0;
  }
  offsets_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  for (const Box3& box : boxes)
  {
    ++offsets_[cellNumber(box) + 1];
  }
  for (std::size_t i = 1; i < offsets_.size(); ++i)
  {
    offsets_[i] += offsets_[i - 1];
  }
  items_.resize(boxes.size());
  boxes_.resize(boxes.size());
  for (std::size_t i = boxes.size(); i-- > 0;)  // backwards: offsets end up at each row's start
  {
    const int row = cellNumber(boxes[i]) + 1;
    const Index place = --offsets_[row];
    items_[place] = static_cast<Index>(i);
    boxes_[place] = boxes[i];
  }
  std::rotate(offsets_.begin(), offsets_.begin() + 1, offsets_.end());
  offsets_.back() = static_cast<Index>(boxes.size());
}

}  // namespace soft_tissue
