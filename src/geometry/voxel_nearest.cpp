#include <array>
#include <cmath>
#include <limits>

#include "voxel_patch.h"

namespace soft_tissue
{
namespace
{
/** Squares of distances no larger than this are as good as none, m^2. */
constexpr double kLeast = 1e-300;
/** How much farther than the nearest is remembered, in cells, and how surely nothing else is. */
constexpr double kRemembered = 0.6;
constexpr double kSurely = 1.0 - 1e-9;
}  // namespace

/** Of what a hint knows, or of everything where it does not know enough. */
VoxelShape::Nearest VoxelShape::nearest(const Vec3& p, NearestHint* hint) const
{
  Nearest known;
  if (hint != nullptr && hint->surface == version_)
  {
    const double moved = (p - hint->at).norm();
    double far = std::numeric_limits<double>::infinity();
    for (int k = 0; k < hint->count && hint->near[k].least - moved <= far; ++k)
    {
      const NearestHint::Place& place = hint->near[k];
      known.take({place.piece, patches_[place.piece].surface.nearestOn(place.triangle, p)});
      far = std::sqrt(known.at.at.squared_distance);
    }
    if (far + moved < hint->reach)
    {
      return known;
    }
    if (!std::isfinite(far))
    {
      known = {};
    }
  }
  const Nearest found = search(p, known);
  if (hint != nullptr && found.piece >= 0)
  {
    remember(p, found, *hint);
  }
  return found;
}

/** @param known  bounds the search; none: the patch whose box is nearest does */
VoxelShape::Nearest VoxelShape::search(const Vec3& p, const Nearest& known) const
{
  Nearest found = known;
  if (found.piece < 0)
  {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < patches_.size(); ++i)
    {
      const double squared = boxes_[i].squaredDistance(p);
      if (squared < least)
      {
        least = squared;
        found.piece = static_cast<Index>(i);
      }
    }
    if (found.piece < 0)
    {
      return found;
    }
    found.at = patches_[found.piece].surface.nearest(p);
  }
  const Index first = known.piece < 0 ? found.piece : -1;
  for (Index i = 0; i < static_cast<Index>(patches_.size()); ++i)
  {
    // A little more than there is, so that ties are found as well.
    const double bound = SignedSurface::kTied * found.at.at.squared_distance + kLeast;
    if (i != first && boxes_[i].squaredDistance(p) <= bound)
    {
      const SignedSurface::Nearest here = patches_[i].surface.nearest(p, bound);
      if (here.triangle >= 0)
      {
        found.take({i, here});
      }
    }
  }
  return found;
}

/** Writes down what is near p, and a little farther than the nearest. */
void VoxelShape::remember(const Vec3& p, const Nearest& found, NearestHint& hint) const
{
  std::array<Nearest, NearestHint::kMost + 1> list;
  std::size_t count = 0;
  const double reach = std::sqrt(found.at.at.squared_distance) + kRemembered * cells_.cellSize();
  double squared = reach * reach;
  for (Index i = 0; i < static_cast<Index>(patches_.size()); ++i)
  {
    if (boxes_[i].squaredDistance(p) > squared)
    {
      continue;
    }
    patches_[i].surface.forEachWithin(p, squared, [&](const SignedSurface::Nearest& here) {
      if (here.at.squared_distance > squared)
      {
        return;
      }
      std::size_t place = count++;
      for (; place > 0 && Nearest{i, here}.isBefore(list[place - 1]); --place)
      {
        list[place] = list[place - 1];
      }
      list[place] = {i, here};
      if (count > NearestHint::kMost)
      {
        squared = list[--count].at.at.squared_distance;
      }
    });
  }
  hint.surface = version_;
  hint.at = p;
  hint.reach = kSurely * std::sqrt(squared);
  hint.count = static_cast<int>(count);
  for (std::size_t k = 0; k < count; ++k)
  {
    const double distance = kSurely * std::sqrt(list[k].at.at.squared_distance);
    const float rounded = std::nextafter(static_cast<float>(distance), 0.0F);
    hint.near[k] = {list[k].piece, list[k].at.triangle, rounded};
  }
}

SignedDistance VoxelShape::distanceTo(const Nearest& found, const Vec3& p) const
{
  if (found.piece < 0)
  {
    const bool inside = cells_.occupied(cells_.cellOf(p));
    return {inside ? -kPatch * cells_.cellSize() : std::numeric_limits<double>::infinity(),
            Vec3::UnitZ()};
  }
  return patches_[found.piece].surface.distance(p, found.at);
}

Mat3 VoxelShape::curvatureOf(const Nearest& found, const Vec3& p) const
{
  return found.piece < 0 ? Mat3(Mat3::Zero())
                         : patches_[found.piece].surface.curvature(p, found.at);
}

SignedDistance VoxelShape::distance(const Vec3& p) const
{
  return distanceTo(nearest(p, nullptr), p);
}

SignedDistance VoxelShape::distance(const Vec3& p, NearestHint& hint) const
{
  return distanceTo(nearest(p, &hint), p);
}

Mat3 VoxelShape::curvature(const Vec3& p) const
{
  return curvatureOf(nearest(p, nullptr), p);
}

Mat3 VoxelShape::curvature(const Vec3& p, NearestHint& hint) const
{
  return curvatureOf(nearest(p, &hint), p);
}

}  // namespace soft_tissue
