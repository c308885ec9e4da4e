#include "soft_tissue_sim/mesh/surface_points.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue
{
namespace
{
/** Two triangles of one square and a small one at their side: only some edges are long. */
TriMesh uneven()
{
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0.2), Vec3(1.1, 0.5, 0.1)},
          {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}};
}

Vec3 areaVector(const Points& x, const Triangle& t)
{
  return 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

struct Cut
{
  TriMesh mesh;
  SurfacePoints surface;
  Points at;

  Cut(const TriMesh& rest, double longest) : mesh(rest), surface(cutSurface(rest, longest))
  {
    placePoints(surface, mesh.nodes, at);
  }
};

TEST(SurfacePoints, CutsEdgesUntilNoneIsLonger)
{
  for (const double longest : {0.7, 0.3, 0.11})
  {
    const Cut cut(uneven(), longest);
    double found = 0.0;
    for (const Edge& e : cut.surface.surface.edges)
    {
      found = std::max(found, (cut.at[e[1]] - cut.at[e[0]]).norm());
    }
    EXPECT_LE(found, longest);
    EXPECT_GT(found, 0.25 * longest);
  }
}

TEST(SurfacePoints, KeepTheSurfaceAndItsSides)
{
  const Cut cut(uneven(), 0.2);
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  double area_before = 0.0, area_after = 0.0;
  for (const Triangle& t : cut.mesh.triangles)
  {
    before += areaVector(cut.mesh.nodes, t);
    area_before += areaVector(cut.mesh.nodes, t).norm();
  }
  for (const Triangle& t : cut.surface.surface.triangles)
  {
    after += areaVector(cut.at, t);
    area_after += areaVector(cut.at, t).norm();
  }
  EXPECT_NEAR((after - before).norm(), 0.0, 1e-14);
  EXPECT_NEAR(area_after, area_before, 1e-14);
}

// V - E + F of a disc is 1, and stays so only if no edge is cut for one of its triangles alone.
TEST(SurfacePoints, LeaveNoGaps)
{
  const Cut cut(uneven(), 0.15);
  const BoundarySurface& surface = cut.surface.surface;
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  EXPECT_EQ(count(cut.at) - count(surface.edges) + count(surface.triangles), 1);
  EXPECT_EQ(surface.nodes.size(), cut.at.size());
}

TEST(SurfacePoints, AreWhereTheirTriangleIs)
{
  const Cut cut(makeSheet({2, 3}, {1.0, 1.0}, SheetPattern::irregular), 0.2);
  Mat3 f;
  f << 1.2, 0.3, 0.0, -0.1, 0.8, 0.2, 0.4, 0.1, 1.0;
  Points moved = cut.mesh.nodes, found;
  for (Vec3& p : moved)
  {
    p = f * p;
  }
  placePoints(cut.surface, moved, found);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const auto& weight = cut.surface.points[i].weight;
    EXPECT_NEAR((found[i] - f * cut.at[i]).norm(), 0.0, 1e-14);
    EXPECT_DOUBLE_EQ(weight[0] + weight[1] + weight[2], 1.0);
  }
}

TEST(SurfacePoints, AreTheNodesWhereNothingIsLong)
{
  const Cut cut(uneven(), 2.0);
  EXPECT_EQ(cut.at, cut.mesh.nodes);
  EXPECT_EQ(cut.surface.surface.triangles, cut.mesh.triangles);
}

TEST(SurfacePoints, RejectLengthsThatAreNone)
{
  EXPECT_THROW(cutSurface(uneven(), 0.0), Error);
  EXPECT_THROW(cutSurface(uneven(), std::nan("")), Error);
}

}  // namespace
}  // namespace soft_tissue
