#include "marker_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Points;
using soft_tissue::Tet;
using soft_tissue::Vec3;
using visualization_msgs::Marker;

/** The unit cube as six tets around its diagonal. */
struct Cube
{
  Points nodes;
  std::vector<Tet> tets = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                           {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

  Cube()
  {
    for (int i = 0; i < 8; ++i)
    {
      nodes.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
    }
  }
};

double area(const Marker& marker)
{
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < marker.points.size(); i += 3)
  {
    const auto at = [&](std::size_t k) {
      const auto& p = marker.points[i + k];
      return Vec3(p.x, p.y, p.z);
    };
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

TEST(AddSlice, coversTheWholeCrossSection)
{
  const Cube cube;
  const std::vector<double> depth(8, 0.1);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double offset : {0.001, 0.25, 0.5, 0.77})
    {
      Marker marker = makeMarker("slice", Marker::TRIANGLE_LIST);
      addSlice(marker, cube.nodes, cube.tets, depth, axis, offset, 1.0);
      EXPECT_NEAR(area(marker), 1.0, 1e-12) << "axis " << axis << " offset " << offset;
      EXPECT_EQ(marker.points.size(), marker.colors.size());
    }
  }
}

TEST(AddSlice, leavesOutTetsWithoutDepthAndMissesWhatItDoesNotCut)
{
  const Cube cube;
  std::vector<double> depth(8, 0.1);
  depth[1] = std::numeric_limits<double>::quiet_NaN();  // node of two of the six tets
  Marker marker = makeMarker("slice", Marker::TRIANGLE_LIST);
  addSlice(marker, cube.nodes, cube.tets, depth, 0, 0.5, 1.0);
  EXPECT_LT(area(marker), 0.999);
  EXPECT_GT(area(marker), 0.001);
  marker.points.clear();
  addSlice(marker, cube.nodes, cube.tets, depth, 0, 1.5, 1.0);
  EXPECT_TRUE(marker.points.empty());
}

TEST(NodeNormals, ofAPyramidPointUp)
{
  const Points nodes = {Vec3(1, 0, 0),  Vec3(0, 1, 0), Vec3(-1, 0, 0),
                        Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(9, 9, 9)};
  const auto normals = nodeNormals(nodes, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_TRUE(normals[4].isApprox(Vec3::UnitZ(), 1e-14));
  EXPECT_TRUE(normals[5].isZero(0.0));
}

TEST(Lit, faceTowardsTheLightIsBrighterThanOneAway)
{
  const std_msgs::ColorRGBA colour = tissueColour(0.5);
  EXPECT_GT(lit(colour, Vec3::UnitZ()).r, lit(colour, -Vec3::UnitZ()).r);
  EXPECT_EQ(lit(colour, Vec3::UnitZ()).a, 1.0F);
}

TEST(Colours, areClampedToTheirScale)
{
  EXPECT_EQ(tissueColour(2.0).r, tissueColour(1.0).r);
  EXPECT_EQ(depthColour(-1.0).b, depthColour(0.0).b);
  EXPECT_NE(depthColour(0.2).g, depthColour(0.6).g);
}

}  // namespace
}  // namespace soft_tissue_sim
