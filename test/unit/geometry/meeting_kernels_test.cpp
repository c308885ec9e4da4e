#include "soft_tissue_sim/geometry/meeting_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "soft_tissue_sim/geometry/clip.h"
#include "soft_tissue_sim/geometry/tet_overlap.h"
#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
namespace
{
using Corners = std::array<Vec3, 4>;

/** Tets of all shapes, needles and nearly flat ones among them, some with a corner in common. */
std::array<Corners, 2> randomTets(RandomGeometry& random, int trial)
{
  std::array<Corners, 2> tets;
  for (Corners& tet : tets)
  {
    const Vec3 centre = random.point(0.5);
    for (Vec3& corner : tet)
    {
      corner = centre + random.point(1.0);
      corner.z() = trial % 5 == 4 ? centre.z() + 1e-4 * corner.z() : corner.z();
      corner.y() = trial % 7 == 6 ? centre.y() + 1e-5 * corner.y() : corner.y();
    }
  }
  tets[1][2] = trial % 3 == 2 ? tets[0][trial % 4] : tets[1][2];
  return tets;
}

void setPoint(float (&lanes)[3][kMeetingLanes], int lane, const Vec3& p)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    lanes[axis][lane] = static_cast<float>(p[axis]);
  }
}

void setPoint(float (&place)[4], const Vec3& p)
{
  std::copy(p.begin(), p.end(), place);
}

class MeetingKernelsOf : public testing::TestWithParam<InstructionSet>
{
 protected:
  /** What is said of a pair as seen from its first corner, scaled. */
  Meeting tets(const Corners& a, const Corners& b, double scale = 1.0) const
  {
    TetPairLanes lanes = {};
    Meeting meetings[kMeetingLanes];
    for (int k = 0; k < 4; ++k)
    {
      setPoint(lanes.b[k], lane_, scale * (b[k] - a[0]));
    }
    for (int k = 1; k < 4; ++k)
    {
      setPoint(lanes.a[k - 1], lane_, scale * (a[k] - a[0]));
    }
    kernels_.tets(lanes, meetings);
    return meetings[lane_];
  }
  Meeting segment(const Corners& tet, const Vec3& p, const Vec3& q, double scale = 1.0,
                  float margin = 0.0f) const
  {
    TetSegmentLanes lanes = {};
    for (int k = 1; k < 4; ++k)
    {
      setPoint(lanes.tet[k - 1][lane_], scale * (tet[k] - tet[0]));
    }
    setPoint(lanes.ends[0][lane_], scale * (p - tet[0]));
    setPoint(lanes.ends[1][lane_], scale * (q - tet[0]));
    return (kernels_.segments(lanes, margin) >> lane_ & 1u) != 0 ? Meeting::apart
                                                                 : Meeting::unclear;
  }

  const MeetingKernels& kernels_ = meetingKernels(GetParam());
  int lane_ = 0;
};
}  // namespace

TEST_P(MeetingKernelsOf, TetsAreAsSeparatingAxesSay)
{
  RandomGeometry random(1);
  int told[2] = {0, 0}, unclear = 0;
  constexpr int kTrials = 40000;
  for (int trial = 0; trial < kTrials; ++trial)
  {
    lane_ = trial % kMeetingLanes;
    const std::array<Corners, 2> pair = randomTets(random, trial);
    const Meeting meeting = tets(pair[0], pair[1]);
    const bool truth = tetsOverlap(pair[0], pair[1]);
    ++(meeting == Meeting::unclear ? unclear : told[truth]);
    ASSERT_NE(meeting, truth ? Meeting::apart : Meeting::together) << trial;
  }
  EXPECT_GT(told[0], kTrials / 10);
  EXPECT_GT(told[1], kTrials / 10);
  EXPECT_LT(unclear, kTrials * 2 / 3);  // every second pair is flat or shares a corner
}

TEST_P(MeetingKernelsOf, OrdinaryTetsAreSeldomUnclear)
{
  RandomGeometry random(2);
  int unclear = 0;
  for (int trial = 0; trial < 4000; ++trial)
  {
    Corners a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, b = a;
    const Pose X = random.pose(1.0);
    for (Vec3& p : b)
    {
      p = X * p;
    }
    unclear += tets(a, b) == Meeting::unclear;
  }
  EXPECT_LT(unclear, 100);
}

TEST_P(MeetingKernelsOf, DropOnlySegmentsThatMiss)
{
  RandomGeometry random(3);
  int dropped = 0, missed = 0;
  for (int trial = 0; trial < 40000; ++trial)
  {
    lane_ = trial % kMeetingLanes;
    const Corners tet = randomTets(random, trial)[0];
    Vec3 p = random.point(1.2), q = trial % 11 == 5 ? p : random.point(1.2);
    p = trial % 4 == 3 ? tet[trial % 3] : p;  // touches a corner
    const auto coordinates = tetCoordinates(tet[0], tet[1], tet[2], tet[3]);
    const bool hit = coordinates && clipSegment(p, q, *coordinates);
    const Meeting meeting = segment(tet, p, q);
    ASSERT_NE(meeting, Meeting::together);
    ASSERT_FALSE(hit && meeting == Meeting::apart) << trial;
    missed += !hit;
    dropped += meeting == Meeting::apart;
  }
  EXPECT_GT(dropped, missed / 2);
}

TEST_P(MeetingKernelsOf, DropOnlySegmentsThatMissWhereverBothMoveWithinTheMargin)
{
  RandomGeometry random(5);
  int dropped = 0, kept = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    lane_ = trial % kMeetingLanes;
    const Corners tet = randomTets(random, trial)[0];
    const Vec3 p = random.point(1.2), q = trial % 11 == 5 ? p : random.point(1.2);
    const double margin = 0.02 * (trial % 10);
    if (segment(tet, p, q, 1.0, static_cast<float>(margin)) == Meeting::unclear)
    {
      ++kept;
      continue;
    }
    ++dropped;
    for (int way = 0; way < 20; ++way)
    {
      // The segment goes towards a corner by its share, corners by theirs towards the segment.
      const double share = way % 4 / 3.0;
      Corners moved = tet;
      for (int k = 0; k < 4; ++k)
      {
        const Vec3 to = (way % 2 == 0 ? p : q) - tet[k];
        moved[k] += (1.0 - share) * margin * (way < 10 ? to : random.point(1.0)).normalized();
      }
      const Vec3 on = share * margin * (tet[way % 4] - 0.5 * (p + q)).normalized();
      const auto coordinates = tetCoordinates(moved[0], moved[1], moved[2], moved[3]);
      ASSERT_FALSE(coordinates && clipSegment(p + on, q + on, *coordinates)) << trial;
    }
  }
  EXPECT_GT(dropped, 2000);
  EXPECT_GT(kept, 2000);
}

TEST_P(MeetingKernelsOf, AreUnsureOfWhatHasNoSizeOrIsNoNumber)
{
  const Corners a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  Corners apart = a;
  for (Vec3& p : apart)
  {
    p += Vec3(3, 0, 0);
  }
  EXPECT_EQ(tets(a, a), Meeting::together);
  EXPECT_EQ(tets(a, apart), Meeting::apart);
  for (const double scale : {0.0, 1e-15, 1e-30, 1e11, 1e30, 1e300})
  {
    EXPECT_EQ(tets(a, a, scale), Meeting::unclear) << scale;
    EXPECT_EQ(tets(a, apart, scale), Meeting::unclear) << scale;
    EXPECT_EQ(segment(a, apart[0], apart[1], scale), Meeting::unclear) << scale;
  }
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        Corners broken = a;
        broken[corner][axis] = bad;
        EXPECT_EQ(tets(a, broken), Meeting::unclear);
        EXPECT_EQ(tets(broken, apart), Meeting::unclear);
        EXPECT_EQ(segment(broken, apart[0], apart[1]), Meeting::unclear);
        EXPECT_EQ(segment(a, apart[0], broken[corner]), Meeting::unclear);
      }
    }
  }
}

TEST(MeetingKernels, SayTheSameOnEveryMachine)
{
  const InstructionSet best = instructionSet();
  RandomGeometry random(4);
  for (int trial = 0; trial < 5000 && best != InstructionSet::baseline; ++trial)
  {
    TetPairLanes tets = {};
    TetSegmentLanes segments = {};
    for (int lane = 0; lane < kMeetingLanes; ++lane)
    {
      const std::array<Corners, 2> pair = randomTets(random, trial + lane);
      for (int k = 0; k < 4; ++k)
      {
        setPoint(tets.b[k], lane, pair[1][k] - pair[0][0]);
      }
      for (int k = 1; k < 4; ++k)
      {
        setPoint(tets.a[k - 1], lane, pair[0][k] - pair[0][0]);
        setPoint(segments.tet[k - 1][lane], pair[0][k] - pair[0][0]);
      }
      setPoint(segments.ends[0][lane], pair[1][0] - pair[0][0]);
      setPoint(segments.ends[1][lane], pair[1][1] - pair[0][0]);
    }
    Meeting plain[kMeetingLanes], wide[kMeetingLanes];
    meetingKernels(InstructionSet::baseline).tets(tets, plain);
    meetingKernels(best).tets(tets, wide);
    ASSERT_EQ(std::memcmp(plain, wide, sizeof(plain)), 0) << trial;
    ASSERT_EQ(meetingKernels(InstructionSet::baseline).segments(segments, 0.1f),
              meetingKernels(best).segments(segments, 0.1f))
        << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, MeetingKernelsOf,
                         testing::Values(InstructionSet::baseline, instructionSet()),
                         [](const testing::TestParamInfo<InstructionSet>& info) {
                           return std::string(info.index == 0 ? "plain_" : "best_") +
                                  name(info.param);
                         });

}  // namespace soft_tissue::test
