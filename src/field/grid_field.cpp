#include "soft_tissue_sim/field/grid_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid_band.h"
#include "grid_reader.h"
#include "node_heap.h"
#include "soft_tissue_sim/base/error.h"
#include "upwind.h"

namespace soft_tissue
{
namespace
{
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/** Jumps across the border of an updated region, in cells: less is taken as it is, more makes the
 * whole grid be marched anew; what is between is led over across some cells. */
constexpr double kSmallJump = 0.01;
constexpr double kLargeJump = 0.25;
constexpr int kBlendCells = 3;

enum class State : char
{
  far,    ///< no value yet
  trial,  ///< in the heap
  known,
};
}  // namespace

class GridField::Marching
{
 public:
  Marching(const GridSpec& grid, GridOrder order)
      : grid_(grid.checked()),
        second_(order == GridOrder::second),
        dimension_(grid.count[2] > 1 ? 3 : 2),
        stride_{1, grid.count[0], grid.count[0] * grid.count[1]},
        depth_(grid.size(), kNone),
        state_(grid.size(), State::far),
        band_(grid, second_ ? 2 : 1),
        heap_(grid.size())
  {}

  void march(const BoundarySurface& surface, const Points& x)
  {
    std::fill(depth_.begin(), depth_.end(), kNone);
    std::fill(state_.begin(), state_.end(), State::far);
    region_ = GridRegion::whole(grid_);
    marchRegion(surface, x);
  }

  GridUpdate update(const std::vector<Box3>& boxes, const BoundarySurface& surface, const Points& x)
  {
    GridUpdate report;
    for (const GridRegion& region : mergedRegions(grid_, boxes))
    {
      region_ = region;
      report.points += renewRegion(surface, x, report);
    }
    if (report.largest_jump > kLargeJump * grid_.spacing.head(dimension_).minCoeff())
    {
      march(surface, x);
      report.whole = true;
    }
    return report;
  }

  void place(const GridSpec& grid)
  {
    if (grid.count != grid_.count)
    {
      throw Error("grid field: a grid that is placed anew keeps its counts of points");
    }
    grid_ = grid.checked();
    band_.place(grid);
  }

  const GridSpec& grid() const { return grid_; }
  const std::vector<double>& depth() const { return depth_; }
  std::uint64_t evaluations() const { return evaluations_ + band_.evaluations(); }

 private:
  /** Marches within region_, whose points are far, from the surface and from known points beside
   * it. */
  void marchRegion(const BoundarySurface& surface, const Points& x)
  {
    const std::vector<GridBand::Value>& band = band_.collect(region_, surface, x);
    for (const GridBand::Value& value : band)
    {
      depth_[value.grid_point] = value.depth;
      state_[value.grid_point] = State::known;
    }
    for (const GridBand::Value& value : band)
    {
      if (value.depth > 0.0)
      {
        relaxNeighbours(value.grid_point);
      }
    }
    forBorder([&](Index inside, Index outside) {
      if (state_[outside] == State::known && depth_[outside] > 0.0 &&
          state_[inside] != State::known)
      {
        relax(inside);
      }
    });
    while (!heap_.empty())
    {
      const Index point = heap_.pop();
      state_[point] = State::known;
      relaxNeighbours(point);
    }
  }

  /** Marches region_ anew and fits it to what is around. @return how many points it has */
  Index renewRegion(const BoundarySurface& surface, const Points& x, GridUpdate& report)
  {
    implied_.clear();
    forBorder([&](Index /*inside*/, Index outside) { implied_.push_back(implied(outside)); });
    old_.clear();
    region_.forPoints(grid_, [&](Index point) {
      old_.push_back(depth_[point]);
      depth_[point] = kNone;
      state_[point] = State::far;
    });
    marchRegion(surface, x);
    double jump = 0.0;
    std::size_t pair = 0;
    forBorder([&](Index /*inside*/, Index outside) {
      const double change = std::abs(implied(outside) - implied_[pair++]);
      jump = change > jump ? change : jump;
    });
    report.largest_jump = std::max(report.largest_jump, jump);
    const double cell = grid_.spacing.head(dimension_).minCoeff();
    if (jump > kSmallJump * cell && jump <= kLargeJump * cell)
    {
      blend();
      report.blended = true;
    }
    return static_cast<Index>(old_.size());
  }

  /** Leads over from what was there to what is there now, across some cells from the border on. */
  void blend()
  {
    std::size_t place = 0;
    region_.forPoints(grid_, [&](Index point) {
      const double before = old_[place++];
      int away = kBlendCells;
      for (int axis = 0; axis < dimension_; ++axis)
      {
        const Index here = point / stride_[axis] % grid_.count[axis];
        away = region_.first[axis] > 0 ? std::min(away, here - region_.first[axis]) : away;
        away = region_.last[axis] + 1 < grid_.count[axis]
                   ? std::min(away, region_.last[axis] - here)
                   : away;
      }
      const double share = (away + 1.0) / (kBlendCells + 1.0);
      if (before > 0.0 && depth_[point] > 0.0)
      {
        depth_[point] = share * depth_[point] + (1.0 - share) * before;
      }
    });
  }

  /** Calls visit(inside, outside) for pairs of neighbours across the border of region_. */
  template <typename Visit>
  void forBorder(const Visit& visit) const
  {
    for (int axis = 0; axis < dimension_; ++axis)
    {
      for (const bool upper : {false, true})
      {
        GridRegion side = region_;
        int& end = upper ? side.first[axis] : side.last[axis];
        end = upper ? region_.last[axis] : region_.first[axis];
        const int outside = end + (upper ? 1 : -1);
        if (outside >= 0 && outside < grid_.count[axis])
        {
          const Index step = upper ? stride_[axis] : -stride_[axis];
          side.forPoints(grid_, [&](Index point) { visit(point, point + step); });
        }
      }
    }
  }

  /** What the neighbours make of a point's depth; NaN for one that has none. */
  double implied(Index point) const
  {
    return state_[point] == State::known && depth_[point] > 0.0 ? upwind(point) : kNone;
  }

  void relaxNeighbours(Index point)
  {
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const Index place = point / stride_[axis] % grid_.count[axis];
      if (place > region_.first[axis] && state_[point - stride_[axis]] != State::known)
      {
        relax(point - stride_[axis]);
      }
      if (place < region_.last[axis] && state_[point + stride_[axis]] != State::known)
      {
        relax(point + stride_[axis]);
      }
    }
  }

  void relax(Index point)
  {
    ++evaluations_;
    const double value = upwind(point);
    if (state_[point] == State::far || value < depth_[point])
    {
      state_[point] = State::trial;
      depth_[point] = value;
      heap_.pushOrDecrease(point, value);
    }
  }

  double upwind(Index point) const
  {
    Difference differences[3];
    int count = 0;
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const Index place = point / stride_[axis] % grid_.count[axis];
      const double weight = 1.0 / (grid_.spacing[axis] * grid_.spacing[axis]);
      bool found = false;
      Difference best = {};
      for (const int way : {-1, 1})
      {
        const Index step = way * stride_[axis];
        const Index near = place + way, far = place + 2 * way;
        if (near < 0 || near >= grid_.count[axis] || state_[point + step] != State::known)
        {
          continue;
        }
        const double v1 = depth_[point + step];
        if (found && v1 >= best.least)
        {
          continue;
        }
        found = true;
        best = {weight, v1, v1};
        if (second_ && far >= 0 && far < grid_.count[axis] &&
            state_[point + 2 * step] == State::known && depth_[point + 2 * step] <= v1)
        {
          best = {2.25 * weight, (4.0 * v1 - depth_[point + 2 * step]) / 3.0, v1};
        }
      }
      if (found)
      {
        insert(differences, count, best);
      }
    }
    return solveUpwind(differences, count);
  }

  GridSpec grid_;
  bool second_;
  int dimension_;
  Index stride_[3];
  std::vector<double> depth_;
  std::vector<State> state_;
  GridBand band_;
  GridRegion region_;  ///< that is being marched
  // Before its points were marched anew: what they had, and what they made of those beside them.
  std::vector<double> old_, implied_;
  NodeHeap heap_;
  std::uint64_t evaluations_ = 0;
};

GridField::GridField(const GridSpec& grid, GridOrder order)
    : marching_(std::make_unique<Marching>(grid, order))
{}

GridField::~GridField() = default;
GridField::GridField(GridField&&) noexcept = default;
GridField& GridField::operator=(GridField&&) noexcept = default;

void GridField::march(const BoundarySurface& surface, const Points& x)
{
  marching_->march(surface, x);
}

GridUpdate GridField::update(const std::vector<Box3>& boxes, const BoundarySurface& surface,
                             const Points& x)
{
  return marching_->update(boxes, surface, x);
}

void GridField::place(const GridSpec& grid)
{
  marching_->place(grid);
}

const GridSpec& GridField::grid() const
{
  return marching_->grid();
}

const std::vector<double>& GridField::depth() const
{
  return marching_->depth();
}

double GridField::interpolate(const Vec3& p) const
{
  return GridReader(grid(), depth()).interpolate(p);
}

double GridField::extrapolate(const Vec3& p) const
{
  return GridReader(grid(), depth()).extrapolate(p);
}

std::uint64_t GridField::evaluations() const
{
  return marching_->evaluations();
}

}  // namespace soft_tissue
