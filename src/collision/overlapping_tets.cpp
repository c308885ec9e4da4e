#include "soft_tissue_sim/collision/overlapping_tets.h"

#include <algorithm>

#include "soft_tissue_sim/geometry/meeting_kernels.h"
#include "soft_tissue_sim/geometry/tet_overlap.h"

namespace soft_tissue
{
namespace
{
/** Tets of a set and where they are. */
struct PlacedTets
{
  const Index* nodes;
  const Vec3* x;

  const Vec3& corner(Index tet, int k) const { return x[nodes[4 * tet + k]]; }
  std::array<Vec3, 4> corners(Index tet) const
  {
    return {corner(tet, 0), corner(tet, 1), corner(tet, 2), corner(tet, 3)};
  }
};

void setPoint(float (&lanes)[3][kMeetingLanes], int lane, const Vec3& p, const Vec3& origin)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    lanes[axis][lane] = static_cast<float>(p[axis] - origin[axis]);
  }
}
}  // namespace

void findOverlappingTets(const ElementSet& first, const Vec3* x_first, const ElementSet& second,
                         const Vec3* x_second, const std::vector<ElementPair>& candidates,
                         std::vector<ElementPair>& pairs)
{
  const PlacedTets a = {first.nodes, x_first}, b = {second.nodes, x_second};
  const MeetingKernels& kernels = meetingKernels(instructionSet());
  TetPairLanes lanes = {};
  Meeting meetings[kMeetingLanes];
  pairs.clear();
  for (std::size_t begin = 0; begin < candidates.size(); begin += kMeetingLanes)
  {
    const ElementPair* const some = candidates.data() + begin;
    const int count =
        static_cast<int>(std::min<std::size_t>(kMeetingLanes, candidates.size() - begin));
    for (int i = 0; i < count; ++i)
    {
      const Vec3& origin = a.corner(some[i].first, 0);
      for (int k = 0; k < 4; ++k)
      {
        setPoint(lanes.b[k], i, b.corner(some[i].second, k), origin);
      }
      for (int k = 1; k < 4; ++k)
      {
        setPoint(lanes.a[k - 1], i, a.corner(some[i].first, k), origin);
      }
    }
    kernels.tets(lanes, meetings);
    for (int i = 0; i < count; ++i)
    {
      if (meetings[i] == Meeting::together ||
          (meetings[i] == Meeting::unclear &&
           tetsOverlap(a.corners(some[i].first), b.corners(some[i].second))))
      {
        pairs.push_back(some[i]);
      }
    }
  }
}

}  // namespace soft_tissue
