#include "soft_tissue_sim/node/tool_looks.h"

#include <gtest/gtest.h>

#include "support/forceps.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Vec3;
using soft_tissue::VisualConfig;
using visualization_msgs::Marker;

/** The forceps, of which the right jaw has a visual. */
class ToolLooks : public testing::Test
{
 protected:
  ToolLooks() : config_(soft_tissue::test::blockScene(folder_, {2, 2, 1}))
  {
    soft_tissue::ToolConfig& tool =
        soft_tissue::test::addForceps(config_, Vec3(0.0, 0.0, 0.5), 0.0);
    VisualConfig visual;
    visual.mesh_uri = "file:///jaw.stl";
    visual.size = Vec3(1.0, 2.0, 3.0);
    visual.link = tool.linkage.find("right_jaw");
    visual.origin.position_m = Vec3(0.0, 0.0, 0.01);
    tool.visuals = {visual};
    visual.kind = VisualConfig::Kind::sphere;
    visual.size.setConstant(0.02);
    visual.colour_rgba = {0.1, 0.2, 0.3, 1.0};
    tool.visuals.push_back(visual);
  }

  const soft_tissue::test::ScratchFolder folder_;
  soft_tissue::SceneConfig config_;
};

TEST_F(ToolLooks, areVisualsAndTheSurfaceOfPartsWithoutAny)
{
  const soft_tissue::Scene scene(config_);
  const std::vector<ToolLook> looks = toolLooks(scene.tools()[0], config_.tools[0]);
  ASSERT_EQ(looks.size(), 3u);
  const std::size_t right = config_.tools[0].linkage.find("right_jaw");
  EXPECT_EQ(looks[0].marker.type, Marker::MESH_RESOURCE);
  EXPECT_EQ(looks[0].marker.mesh_resource, "file:///jaw.stl");
  EXPECT_EQ(looks[0].marker.scale.y, 2.0);
  EXPECT_EQ(looks[0].link, right);
  EXPECT_EQ(looks[0].X_LM.translation(), Vec3(0.0, 0.0, 0.01));
  EXPECT_EQ(looks[1].marker.type, Marker::SPHERE);
  EXPECT_EQ(looks[1].marker.scale.x, 0.02);
  EXPECT_FLOAT_EQ(looks[1].marker.color.g, 0.2f);
  EXPECT_EQ(looks[2].marker.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(looks[2].link, config_.tools[0].linkage.find("left_jaw"));
  EXPECT_EQ(looks[2].marker.points.size(), 3 * scene.tools()[0].parts[0].surface.triangles.size());
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(looks[i].marker.ns, "tool");
    EXPECT_EQ(looks[i].marker.id, i);
  }
}

TEST_F(ToolLooks, aToolWithoutUrdfIsItsSurface)
{
  soft_tissue::SceneConfig config = soft_tissue::test::blockScene(folder_, {2, 2, 1});
  soft_tissue::test::addTool(config, soft_tissue::SphereShape{0.01},
                             {Vec3(0.0, 0.0, 0.5), Vec3::Zero()}, soft_tissue::Response::segment);
  const soft_tissue::Scene scene(config);
  const std::vector<ToolLook> looks = toolLooks(scene.tools()[0], config.tools[0]);
  ASSERT_EQ(looks.size(), 1u);
  EXPECT_EQ(looks[0].marker.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(looks[0].link, 0u);
  EXPECT_EQ(scene.tools()[0].parts[0].name, "tool");
}

}  // namespace
}  // namespace soft_tissue_sim
