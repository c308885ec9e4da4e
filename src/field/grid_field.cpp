#include "soft_tissue_sim/field/grid_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node_heap.h"
#include "surface_sign.h"
#include "upwind.h"

namespace soft_tissue
{
namespace
{
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

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
        place_(grid.size(), -1),
        heap_(grid.size())
  {}

  void march(const BoundarySurface& surface, const Points& x)
  {
    std::fill(depth_.begin(), depth_.end(), kNone);
    std::fill(state_.begin(), state_.end(), State::far);
    for (const Near& near : band_)
    {
      place_[near.grid_point] = -1;
    }
    band_.clear();
    collectBand(surface, x);
    settleBand(surface, x);
    for (const Near& near : band_)
    {
      if (state_[near.grid_point] == State::known && depth_[near.grid_point] > 0.0)
      {
        relaxNeighbours(near.grid_point);
      }
    }
    while (!heap_.empty())
    {
      const Index point = heap_.pop();
      state_[point] = State::known;
      relaxNeighbours(point);
    }
  }

  double interpolate(const Vec3& p) const
  {
    double sum = 0.0;
    bool inside = false;
    forCorners(p, [&](Index point, double weight) {
      inside = true;
      sum += weight > 0.0 ? weight * depth_[point] : 0.0;
      return true;
    });
    return inside ? sum : kNone;
  }

  double extrapolate(const Vec3& p) const
  {
    double least = kNone;
    forCorners(p, [&](Index point, double /*weight*/) {
      const Vec3 way = p - grid_.point(point);
      const Vec3 slope = slopeAt(point);
      const double steepest = slope.norm();
      const double there =
          depth_[point] + (steepest > 0.0 ? slope.dot(way) / steepest : way.norm());
      least = there < least || std::isnan(least) ? there : least;
      return true;
    });
    return least;
  }

  const GridSpec& grid() const { return grid_; }
  const std::vector<double>& depth() const { return depth_; }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  /** A grid point near the surface, with the nearest triangle whose box it is in. */
  struct Near
  {
    Index grid_point;
    Index triangle;
    TrianglePoint nearest;
  };

  /** Calls visit(point, weight) for the corners of p's cell, until it returns false. */
  template <typename Visit>
  void forCorners(const Vec3& p, const Visit& visit) const
  {
    Index corner = 0;
    double part[3] = {};
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const double place = (p[axis] - grid_.origin[axis]) / grid_.spacing[axis];
      if (!(place >= 0.0 && place <= grid_.count[axis] - 1))
      {
        return;
      }
      const int cell = std::min(static_cast<int>(place), grid_.count[axis] - 2);
      part[axis] = place - cell;
      corner += cell * stride_[axis];
    }
    bool more = true;
    for (int k = 0; k < (1 << dimension_) && more; ++k)
    {
      double weight = 1.0;
      Index point = corner;
      for (int axis = 0; axis < dimension_; ++axis)
      {
        const bool upper = (k >> axis & 1) != 0;
        weight *= upper ? part[axis] : 1.0 - part[axis];
        point += upper ? stride_[axis] : 0;
      }
      more = visit(point, weight);
    }
  }

  /** Differences to the lower neighbour along each axis: the way depth grows. */
  Vec3 slopeAt(Index point) const
  {
    Vec3 slope = Vec3::Zero();
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const Index place = point / stride_[axis] % grid_.count[axis];
      double fall = 0.0;
      for (const int way : {-1, 1})
      {
        const Index other = place + way;
        if (other >= 0 && other < grid_.count[axis])
        {
          const double here = depth_[point] - depth_[point + way * stride_[axis]];
          if (here > fall)
          {
            fall = here;
            slope[axis] = -way * here / grid_.spacing[axis];
          }
        }
      }
    }
    return slope;
  }

  int bandCells() const { return second_ ? 2 : 1; }

  /** All points in the boxes of triangles, made wider by some cells. */
  void collectBand(const BoundarySurface& surface, const Points& x)
  {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    {
      const Triangle& triangle = surface.triangles[t];
      Box3 box;
      for (const Index node : triangle)
      {
        box.extend(x[node]);
      }
      int first[3], last[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const double low = (box.min[axis] - grid_.origin[axis]) / grid_.spacing[axis] - bandCells();
        const double high =
            (box.max[axis] - grid_.origin[axis]) / grid_.spacing[axis] + bandCells();
        const double end = grid_.count[axis] - 1;
        first[axis] =
            axis < dimension_ ? static_cast<int>(std::ceil(std::clamp(low, 0.0, end))) : 0;
        last[axis] =
            axis < dimension_ ? static_cast<int>(std::floor(std::clamp(high, -1.0, end))) : 0;
      }
      for (int k = first[2]; k <= last[2]; ++k)
      {
        for (int j = first[1]; j <= last[1]; ++j)
        {
          for (int i = first[0]; i <= last[0]; ++i)
          {
            offer(grid_.index(i, j, k), static_cast<Index>(t), triangle, x);
          }
        }
      }
    }
  }

  void offer(Index point, Index t, const Triangle& triangle, const Points& x)
  {
    ++evaluations_;
    const TrianglePoint nearest =
        closestOnTriangle(grid_.point(point), x[triangle[0]], x[triangle[1]], x[triangle[2]]);
    if (place_[point] < 0)
    {
      place_[point] = static_cast<Index>(band_.size());
      band_.push_back({point, t, nearest});
    }
    else if (nearest.squared_distance < band_[place_[point]].nearest.squared_distance)
    {
      band_[place_[point]] = {point, t, nearest};
    }
  }

  /** Gives points of the band their exact value. One inside and farther than the band is wide may
   * be nearer to a triangle whose box it isn't in: that is left to the march. */
  void settleBand(const BoundarySurface& surface, const Points& x)
  {
    const SurfaceSign sign(surface, x);
    const double width = bandCells() * grid_.spacing.head(dimension_).minCoeff();
    for (const Near& near : band_)
    {
      const double distance = std::sqrt(near.nearest.squared_distance);
      const bool inside = sign.inside(grid_.point(near.grid_point), near.triangle, near.nearest);
      if (!inside || distance <= width)
      {
        depth_[near.grid_point] = inside ? distance : -distance;
        state_[near.grid_point] = State::known;
      }
    }
  }

  void relaxNeighbours(Index point)
  {
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const Index place = point / stride_[axis] % grid_.count[axis];
      if (place > 0 && state_[point - stride_[axis]] != State::known)
      {
        relax(point - stride_[axis]);
      }
      if (place + 1 < grid_.count[axis] && state_[point + stride_[axis]] != State::known)
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
  std::vector<Near> band_;
  std::vector<Index> place_;  ///< per point: in band_, -1 outside it
  NodeHeap heap_;
  std::uint64_t evaluations_ = 0;
};

GridField::GridField(const GridSpec& grid, GridOrder order)
    : marching_(std::make_unique<Marching>(grid, order))
{}

GridField::~GridField() = default;

void GridField::march(const BoundarySurface& surface, const Points& x)
{
  marching_->march(surface, x);
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
  return marching_->interpolate(p);
}

double GridField::extrapolate(const Vec3& p) const
{
  return marching_->extrapolate(p);
}

std::uint64_t GridField::evaluations() const
{
  return marching_->evaluations();
}

}  // namespace soft_tissue
