#include "soft_tissue_sim/node/urdf_shapes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "support/collada.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::BoxShape;
using soft_tissue::MeshShape;
using soft_tissue::ShapeConfig;
using soft_tissue::SphereShape;
using soft_tissue::Vec3;

class UrdfShapes : public testing::Test
{
 protected:
  std::string writeUrdf(const std::string& links) const
  {
    const std::string file = folder_.path() + "/robot.urdf";
    std::ofstream(file) << "<robot name=\"r\">" << links << "</robot>";
    return file;
  }

  std::string writeLink(const std::string& inner) const
  {
    return writeUrdf("<link name=\"tip\">" + inner + "</link>");
  }

  std::vector<ShapeConfig> shapes(const std::string& file, const std::string& link = "tip") const
  {
    return shapesFromUrdf({file, link}, folder_.path());
  }

  /** What the conversion complains of; empty if of nothing. */
  std::string complaint(const std::string& file, const std::string& link = "tip") const
  {
    try
    {
      shapes(file, link);
      return "";
    }
    catch (const soft_tissue::Error& error)
    {
      return error.what();
    }
  }

  ScratchFolder folder_;
};

std::string collision(const std::string& geometry, const std::string& origin = "")
{
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST_F(UrdfShapes, spheresAndBoxesKeepSizeAndPlace)
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

TEST_F(UrdfShapes, cylinderBecomesAMeshOfNearlyItsVolume)
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

TEST_F(UrdfShapes, meshesAreFoundBesideTheUrdfAndByFileUri)
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

TEST_F(UrdfShapes, colladaMeshesBecomeClosedMeshesInMetres)
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

TEST_F(UrdfShapes, aMeshThatCantBeReadIsNamedWithItsLink)
{
  std::ofstream(folder_.path() + "/broken.dae") << "<COLLADA";
  const std::string text = complaint(writeLink(collision("<mesh filename=\"broken.dae\"/>")));
  EXPECT_TRUE(contains(text, "robot.urdf: link 'tip': ")) << text;
  EXPECT_TRUE(contains(text, "broken.dae: can't be read: ")) << text;
}

TEST_F(UrdfShapes, aNameThatDiffersInCaseIsPointedOut)
{
  std::ofstream(folder_.path() + "/Tool.STL") << "solid a\nendsolid a\n";
  const std::string text = complaint(writeLink(collision("<mesh filename=\"tool.stl\"/>")));
  EXPECT_TRUE(contains(text, "tool.stl")) << text;
  EXPECT_TRUE(contains(text, "Tool.STL")) << text;
}

TEST_F(UrdfShapes, everyMistakeIsNamed)
{
  const std::string link = writeLink(collision("<sphere radius=\"1\"/>"));
  EXPECT_TRUE(contains(complaint(link, "nose"), "link 'nose' does not exist"));
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

class RealUrdfs : public UrdfShapes
{
 protected:
  void SetUp() override
  {
    const char* data = std::getenv("SOFT_TISSUE_DATA");
    if (data == nullptr)
    {
      GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
    }
    tools_ = std::string(data) + "/tools/";
  }

  std::string tools_;
};

TEST_F(RealUrdfs, patientSideManipulator)
{
  const std::string file = tools_ + "psm/psm.urdf";
  EXPECT_EQ(std::get<BoxShape>(shapes(file, "psm_tool_gripper1_link")[0].geometry).size_m,
            Vec3(0.0014, 0.0102, 0.0018));
  const auto roll = shapes(file, "psm_tool_roll_link");
  ASSERT_EQ(roll.size(), 1u);
  EXPECT_GT(soft_tissue::loadTriMesh(std::get<MeshShape>(roll[0].geometry).mesh.file, 1.0)
                .mesh.triangles.size(),
            100u);
  const std::string none = complaint(file, "psm_yaw_link");
  EXPECT_TRUE(contains(none, "psm_tool_pitch_link")) << none;
}

TEST_F(RealUrdfs, needleIsOneMesh)
{
  EXPECT_EQ(shapes(tools_ + "needle/needle_40mm.urdf", "baseLink").size(), 1u);
}

TEST_F(RealUrdfs, missingPackageNamesTheMesh)
{
  const std::string text = complaint(tools_ + "psm/psm_ori.urdf", "psm_tool_roll_link");
  EXPECT_TRUE(contains(text, "package://dvrk_description/psm/meshes/tool_roll_link.STL")) << text;
  EXPECT_TRUE(contains(text, "link 'psm_tool_roll_link'")) << text;
}

}  // namespace
}  // namespace soft_tissue_sim
