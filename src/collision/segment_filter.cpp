#include "soft_tissue_sim/collision/segment_filter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "soft_tissue_sim/geometry/meeting_kernels.h"

namespace soft_tissue
{
namespace
{
void setPoint(float (&place)[4], const Vec3& p)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] = static_cast<float>(p[axis]);
  }
}
}  // namespace

void dropParted(const ElementSet& segments, const Vec3* x_segments, const ElementSet& tets,
                const Vec3* x_tets, double margin, std::vector<ElementPair>& pairs)
{
  const MeetingKernels& kernels = meetingKernels(instructionSet());
  const float most = std::nextafter(static_cast<float>(margin), std::numeric_limits<float>::max());
  TetSegmentLanes lanes = {};
  const int last = segments.nodes_each - 1;
  std::size_t left = 0;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kMeetingLanes)
  {
    const int used = static_cast<int>(std::min<std::size_t>(kMeetingLanes, pairs.size() - begin));
    for (int lane = 0; lane < used; ++lane)
    {
      const ElementPair& pair = pairs[begin + lane];
      const bool again = lane > 0 && pair.second == pairs[begin + lane - 1].second;
      const Index* const tet = tets.nodes + 4 * static_cast<std::size_t>(pair.second);
      const Index* const ends =
          segments.nodes + segments.nodes_each * static_cast<std::size_t>(pair.first);
      const Vec3& origin = x_tets[tet[0]];
      for (int k = 0; k < 3; ++k)
      {
        if (again)
        {
          std::memcpy(lanes.tet[k][lane], lanes.tet[k][lane - 1], sizeof(lanes.tet[k][lane]));
          continue;
        }
        setPoint(lanes.tet[k][lane], x_tets[tet[k + 1]] - origin);
      }
      setPoint(lanes.ends[0][lane], x_segments[ends[0]] - origin);
      setPoint(lanes.ends[1][lane], x_segments[ends[last]] - origin);
    }
    const unsigned parted = kernels.segments(lanes, most);
    for (int lane = 0; lane < used; ++lane)
    {
      pairs[left] = pairs[begin + lane];
      left += (parted >> lane & 1u) == 0 ? 1 : 0;
    }
  }
  pairs.resize(left);
}

}  // namespace soft_tissue
