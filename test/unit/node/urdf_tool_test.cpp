#include "soft_tissue_sim/node/urdf_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "soft_tissue_sim/mesh/mesh_io.h"
#include "support/collada.h"
#include "support/urdf_files.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::BoxShape;
using soft_tissue::MeshShape;
using soft_tissue::SphereShape;
using soft_tissue::ToolConfig;
using soft_tissue::Vec3;

TEST_F(UrdfTool, spheresAndBoxesKeepSizeAndPlace)
{
  const auto found =
      shapes(writeLink(collision("<sphere radius=\"0.004\"/>") +
                       collision("<box size=\"0.01 0.02 0.03\"/>",
                                 "<origin xyz=\"0.1 -0.2 0.3\" rpy=\"0.1 0.2 0.3\"/>")));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(std::get<SphereShape>(found[0].geometry).radius_m, 0.004);
  EXPECT_EQ(std::get<BoxShape>(found[1].geometry).size_m, Vec3(0.01, 0.02, 0.03));
  EXPECT_EQ(found[1].origin.position_m, Vec3(0.1, -0.2, 0.3));
  EXPECT_TRUE(found[1].origin.rotation_rpy_rad.isApprox(Vec3(0.1, 0.2, 0.3), 1e-12));
}

TEST_F(UrdfTool, cylinderBecomesAMeshOfNearlyItsVolume)
{
  const double radius = 0.004;
  const double length = 0.05;
  const auto found = shapes(writeLink(collision("<cylinder radius=\"0.004\" length=\"0.05\"/>")));
  ASSERT_EQ(found.size(), 1u);
  const auto mesh =
      soft_tissue::loadTriMesh(std::get<MeshShape>(found[0].geometry).mesh.file, 1.0).mesh;
  double volume = 0.0;
  for (const soft_tissue::Triangle& t : mesh.triangles)
  {
    volume += mesh.nodes[t[0]].dot(mesh.nodes[t[1]].cross(mesh.nodes[t[2]])) / 6.0;
  }
  // A 24-sided prism with its corners on the cylinder: V = 12 sin(15 deg) r^2 l, outward if
  // positive.
  EXPECT_NEAR(volume, 12.0 * std::sin(M_PI / 12.0) * radius * radius * length, 1e-6 * volume);
  for (const Vec3& node : mesh.nodes)
  {
    EXPECT_LE(node.head<2>().norm(), radius * (1.0 + 1e-6));
    EXPECT_LE(std::abs(node.z()), 0.5 * length * (1.0 + 1e-6));
  }
}

TEST_F(UrdfTool, meshesAreFoundBesideTheUrdfAndByFileUri)
{
  std::ofstream(folder_.path() + "/a.stl") << "solid a\nendsolid a\n";
  for (const std::string& name : {std::string("a.stl"), "file://" + folder_.path() + "/a.stl"})
  {
    const auto found =
        shapes(writeLink(collision("<mesh filename=\"" + name + "\" scale=\"1 2 3\"/>")));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(std::get<MeshShape>(found[0].geometry).mesh.file, folder_.path() + "/a.stl");
    EXPECT_EQ(std::get<MeshShape>(found[0].geometry).scale, Vec3(1.0, 2.0, 3.0));
  }
}

TEST_F(UrdfTool, colladaMeshesBecomeClosedMeshesInMetres)
{
  std::ofstream(folder_.path() + "/hook.dae") << colladaTet(0.001);
  const auto found = shapes(writeLink(collision("<mesh filename=\"hook.dae\" scale=\"1 2 3\"/>")));
  ASSERT_EQ(found.size(), 1u);
  const MeshShape& shape = std::get<MeshShape>(found[0].geometry);
  EXPECT_EQ(shape.scale, Vec3(1.0, 2.0, 3.0));
  EXPECT_TRUE(contains(shape.mesh.file, "hook.dae")) << shape.mesh.file;
  const auto mesh = soft_tissue::loadTriMesh(shape.mesh.file, shape.mesh.metres_per_unit).mesh;
  EXPECT_EQ(mesh.triangles.size(), 4u);
  ASSERT_EQ(mesh.nodes.size(), 4u);  // corners shared again
  for (const Vec3& p : mesh.nodes)
  {
    EXPECT_LE(p.norm(), 0.00301);
  }
}

TEST_F(UrdfTool, aMeshThatCantBeReadIsNamedWithItsLink)
{
  std::ofstream(folder_.path() + "/broken.dae") << "<COLLADA";
  const std::string text = complaint(writeLink(collision("<mesh filename=\"broken.dae\"/>")));
  EXPECT_TRUE(contains(text, "robot.urdf: link 'tip': ")) << text;
  EXPECT_TRUE(contains(text, "broken.dae: can't be read: ")) << text;
}

TEST_F(UrdfTool, aNameThatDiffersInCaseIsPointedOut)
{
  std::ofstream(folder_.path() + "/Tool.STL") << "solid a\nendsolid a\n";
  const std::string text = complaint(writeLink(collision("<mesh filename=\"tool.stl\"/>")));
  EXPECT_TRUE(contains(text, "tool.stl")) << text;
  EXPECT_TRUE(contains(text, "Tool.STL")) << text;
}

TEST_F(UrdfTool, everyMistakeIsNamed)
{
  const std::string link = writeLink(collision("<sphere radius=\"1\"/>"));
  EXPECT_TRUE(contains(complaint(link, "nose"), "link 'nose': does not exist"));
  EXPECT_TRUE(contains(complaint("/nowhere.urdf"), "can't be read"));
  EXPECT_TRUE(contains(complaint(writeLink("")), "no collision geometry"));
  EXPECT_TRUE(contains(complaint(writeUrdf("<link")), "not a valid robot description"));
  EXPECT_TRUE(contains(
      complaint(writeLink(collision("<mesh filename=\"package://no_such_package/a.stl\"/>"))),
      "no_such_package"));
  EXPECT_TRUE(contains(complaint(writeLink(collision("<mesh filename=\"http://a/b.stl\"/>"))),
                       "must be package://, file:// or a path"));
  EXPECT_TRUE(contains(complaint(writeLink(collision("<mesh filename=\"package://a\"/>"))),
                       "package://PACKAGE/PATH"));
}

TEST_F(UrdfTool, eachMissingMeshIsNamed)
{
  const std::string text = complaint(writeLink(collision("<mesh filename=\"a.stl\"/>") +
                                               collision("<sphere radius=\"1\"/>") +
                                               collision("<mesh filename=\"b.stl\"/>")));
  EXPECT_TRUE(contains(text, "a.stl")) << text;
  EXPECT_TRUE(contains(text, "b.stl")) << text;
}

TEST_F(UrdfTool, visualsAreTakenAsTheyAreAndMissingOnesRemarkedOn)
{
  std::ofstream(folder_.path() + "/look.stl") << "solid a\nendsolid a\n";
  const ToolConfig config = tool(
      writeLink(collision("<sphere radius=\"1\"/>") +
                "<visual><origin xyz=\"1 2 3\"/><geometry><mesh filename=\"look.stl\" scale=\"1 2 "
                "3\"/></geometry><material name=\"m\"><color rgba=\"0.1 0.2 0.3 0.4\"/></material>"
                "</visual><visual><geometry><cylinder radius=\"0.1\" length=\"0.5\"/></geometry>"
                "</visual><visual><geometry><mesh filename=\"gone.stl\"/></geometry></visual>"),
      {"tip"});
  using Kind = soft_tissue::VisualConfig::Kind;
  ASSERT_EQ(config.visuals.size(), 2u);
  EXPECT_EQ(config.visuals[0].kind, Kind::mesh);
  EXPECT_EQ(config.visuals[0].mesh_uri, "file://" + folder_.path() + "/look.stl");
  EXPECT_EQ(config.visuals[0].size, Vec3(1, 2, 3));
  EXPECT_EQ(config.visuals[0].origin.position_m, Vec3(1, 2, 3));
  EXPECT_NEAR((*config.visuals[0].colour_rgba)[3], 0.4, 1e-6);
  EXPECT_EQ(config.visuals[1].kind, Kind::cylinder);
  EXPECT_EQ(config.visuals[1].size, Vec3(0.2, 0.2, 0.5));
  ASSERT_EQ(config.remarks.size(), 1u);
  EXPECT_TRUE(contains(config.remarks[0], "gone.stl")) << config.remarks[0];
}

}  // namespace
}  // namespace soft_tissue_sim
