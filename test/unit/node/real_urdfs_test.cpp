#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/node/scene_loader.h"
#include "support/urdf_files.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::BoxShape;
using soft_tissue::MeshShape;
using soft_tissue::ToolConfig;
using soft_tissue::Vec3;

class RealUrdfs : public UrdfTool
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

TEST_F(RealUrdfs, theManipulatorsJawsTurnAgainstEachOther)
{
  const ToolConfig config = tool(tools_ + "psm/psm.urdf",
                                 {"psm_tool_roll_link", "psm_tool_pitch_link",
                                  "psm_tool_gripper1_link", "psm_tool_gripper2_link"},
                                 "psm_tool_tip_link");
  const auto& joints = config.linkage.coordinates();
  ASSERT_EQ(joints.size(), 3u);
  const std::size_t jaw = config.linkage.findCoordinate("psm_tool_gripper2_joint");
  ASSERT_LT(jaw, 3u);
  EXPECT_EQ(joints[jaw].lower, -1.0);
  EXPECT_EQ(joints[jaw].max_speed, 2.1);
  EXPECT_EQ(config.shapes.size(), 4u);
  EXPECT_EQ(config.visuals.size(), 4u);
  EXPECT_TRUE(config.remarks.empty());
  soft_tissue::JointValues q = soft_tissue::JointValues::Zero(3);
  q[static_cast<Eigen::Index>(jaw)] = 0.3;
  const std::size_t yaw = config.linkage.find("psm_tool_yaw_link");
  const auto direction = [&](const char* link) -> Vec3 {
    return config.linkage.pose(yaw, config.linkage.find(link), q).linear().col(1);
  };
  EXPECT_LT((direction("psm_tool_gripper1_link") - Vec3(std::sin(0.3), std::cos(0.3), 0)).norm(),
            1e-12);
  EXPECT_LT((direction("psm_tool_gripper2_link") - Vec3(-std::sin(0.3), std::cos(0.3), 0)).norm(),
            1e-12);
}

TEST_F(RealUrdfs, theManipulatorAndTheNeedleBecomeToolsOfAScene)
{
  const std::string file = folder_.path() + "/scene.yaml";
  std::ofstream(file) << "tissues:\n"
                         "  - name: block\n"
                         "    mesh: {file: " SOURCE_DIR
                         "/test/ros/block.msh, length_unit: m}\n"
                         "    material: {young_modulus_pa: 5000, poisson_ratio: 0.4, "
                         "density_kg_per_m3: 1000}\n"
                         "tools:\n"
                         "  - name: psm\n"
                         "    shape: {urdf: {file: "
                      << tools_
                      << "psm/psm.urdf, links: [psm_tool_roll_link, psm_tool_pitch_link, "
                         "psm_tool_gripper1_link, psm_tool_gripper2_link], frame: "
                         "psm_tool_tip_link}}\n"
                         "    initial_pose: {position_m: [0, 0, 1]}\n"
                         "    jaw: {joints: [{joint: psm_tool_gripper2_joint, share: 0.5}]}\n"
                         "  - name: needle\n"
                         "    shape: {urdf: {file: "
                      << tools_
                      << "needle/needle_40mm.urdf, link: baseLink}}\n"
                         "    initial_pose: {position_m: [0, 0, 2]}\n"
                         "contacts:\n"
                         "  - {between: [block, psm]}\n"
                         "  - {between: [block, needle]}\n";
  soft_tissue::Scene scene = buildScene(loadConfig(file));
  ASSERT_EQ(scene.tools().size(), 2u);
  EXPECT_EQ(scene.tools()[0].parts.size(), 4u);
  EXPECT_EQ(scene.tools()[0].parts[3].name, "psm_tool_gripper2_link");
  EXPECT_EQ(scene.tools()[1].parts.size(), 1u);
  EXPECT_FALSE(scene.step().held);
}

TEST_F(RealUrdfs, theManipulatorsJawsLiftAStripAndLetItGo)
{
  const std::string file = folder_.path() + "/scene.yaml";
  std::ofstream(file) << R"(
time_step_s: 0.005
gravity_m_per_s2: [0, 0, 0]
tissues:
  - name: strip
    mesh: {file: )" SOURCE_DIR R"(/test/ros/strip.msh, length_unit: m}
    pose: {position_m: [-0.005, -0.003, 0.01]}
    material: {young_modulus_pa: 20000, poisson_ratio: 0.4, density_kg_per_m3: 1000,
               mass_damping_per_s: 20}
tools:
  - name: psm
    shape: {urdf: {file: )"
                      << tools_ << R"(psm/psm.urdf, frame: psm_tool_tip_link,
                   links: [psm_tool_roll_link, psm_tool_pitch_link, psm_tool_gripper1_link,
                           psm_tool_gripper2_link]}}
    pose_source:
      keyframes:
        - {time_s: 0.1, position_m: [0, 0, 0.022], rotation_rpy_rad: [3.14159265358979, 0, 0]}
        - {time_s: 0.3, position_m: [0, 0, 0.022], rotation_rpy_rad: [3.14159265358979, 0, 0]}
        - {time_s: 0.7, position_m: [0, 0, 0.042], rotation_rpy_rad: [3.14159265358979, 0, 0]}
    joint_source:
      keyframes:
        - {time_s: 0, values_rad_or_m: {psm_tool_gripper2_joint: 0.6}}
        - {time_s: 0.3, values_rad_or_m: {psm_tool_gripper2_joint: 0.25}}
        - {time_s: 0.8, values_rad_or_m: {psm_tool_gripper2_joint: 0.25}}
        - {time_s: 1.0, values_rad_or_m: {psm_tool_gripper2_joint: 0.6}}
contacts: [{between: [strip, psm], friction: 0.8}]
)";
  soft_tissue::Scene scene = buildScene(loadConfig(file));
  soft_tissue::Snapshot snapshot;
  const auto middleAt = [&](double time_s) {
    while (scene.time() < time_s - 1e-9)
    {
      EXPECT_FALSE(scene.step().held);
    }
    scene.fillSnapshot(snapshot);
    double sum = 0.0;
    for (const Vec3& p : snapshot.tissues[0].positions)
    {
      sum += p.z();
    }
    return sum / static_cast<double>(snapshot.tissues[0].positions.size());
  };
  const double gripped = middleAt(0.3);
  EXPECT_GT(snapshot.tools[0].parts[2].wrench_W.force.norm(), 0.05) << "one finger presses";
  EXPECT_GT(snapshot.tools[0].parts[3].wrench_W.force.norm(), 0.05) << "and the other";
  EXPECT_NEAR(middleAt(0.8) - gripped, 0.02, 5e-5);
  middleAt(1.0);
  EXPECT_TRUE(snapshot.tools[0].contacts.empty());
  EXPECT_EQ(snapshot.tools[0].wrench_W.force, Vec3::Zero());
}

/** Puts the driver's folder into a package, by the name its URDF has for it or another. */
class Driver : public RealUrdfs
{
 protected:
  void SetUp() override
  {
    RealUrdfs::SetUp();
    if (!IsSkipped())
    {
      package_ = folder_.path() + "/dvrk_description";
      std::filesystem::create_directory(package_);
      std::ofstream(package_ + "/package.xml")
          << "<package><name>dvrk_description</name><version>0.0.0</version>"
             "<description>d</description><maintainer email=\"a@b.c\">a</maintainer>"
             "<license>BSD</license></package>";
      before_ = std::getenv("ROS_PACKAGE_PATH");
      setenv("ROS_PACKAGE_PATH", (folder_.path() + ":" + before_).c_str(), 1);
    }
  }
  void TearDown() override
  {
    if (!before_.empty())
    {
      setenv("ROS_PACKAGE_PATH", before_.c_str(), 1);
    }
  }

  ToolConfig driver() const
  {
    return tool(tools_ + "tool_lnd/tool_lnd.urdf",
                {"tool_roll_link", "tool_pitch_link", "gripper1_link", "gripper2_link"});
  }

  std::string package_, before_;
};

TEST_F(Driver, isFoundInItsPackage)
{
  std::filesystem::create_directory_symlink(tools_ + "tool_lnd", package_ + "/Tool_LND");
  const ToolConfig config = driver();
  EXPECT_EQ(config.shapes.size(), 4u);
  ASSERT_EQ(config.linkage.coordinates().size(), 4u);
  for (const soft_tissue::Coordinate& joint : config.linkage.coordinates())
  {
    EXPECT_EQ(joint.upper, std::numeric_limits<double>::infinity()) << joint.name;
  }
}

TEST_F(Driver, inAFolderOfOtherCaseIsPointedOutForEachMesh)
{
  std::filesystem::create_directory_symlink(tools_ + "tool_lnd", package_ + "/tool_lnd");
  try
  {
    driver();
    FAIL();
  }
  catch (const soft_tissue::Error& error)
  {
    EXPECT_TRUE(contains(error.what(), "differs in upper and lower case from 'tool_lnd'"))
        << error.what();
    for (const char* mesh :
         {"tool_roll_link.STL", "tool_pitch_link.STL", "gripper1_link.STL", "gripper2_link.STL"})
    {
      EXPECT_TRUE(contains(error.what(), mesh)) << mesh;
    }
  }
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
  try
  {
    tool(tools_ + "psm/psm_ori.urdf", {"psm_tool_roll_link", "psm_tool_pitch_link"});
    FAIL();
  }
  catch (const soft_tissue::Error& error)
  {
    EXPECT_TRUE(contains(error.what(), "tool_roll_link.STL")) << error.what();
    EXPECT_TRUE(contains(error.what(), "tool_pitch_link.STL")) << error.what();
  }
}

}  // namespace
}  // namespace soft_tissue_sim
