#include <gtest/gtest.h>

#include "bad_scene.h"

namespace soft_tissue
{
namespace
{
#define URDF "{urdf: {file: mesh.msh, links: [a, b]}}"

/** What a second tool, of a URDF, may not say. */
std::vector<BadScene> badJoints()
{
  return {
      {"[a, b]", "[a, b, a]",
       "tools[1].shape.urdf.links[2] = a, is tools[1].shape.urdf.links[0] too, must be new"},
      {"[a, b]", "[a, b], frame: ''", "tools[1].shape.urdf.frame = '', must be a text"},
      {"[a, b]}}", "[a, b]}}\n    joint_source: {topic: /joint_states}",
       "tools[1].joint_source.topic = /joint_states, must be a relative topic name: names joined "
       "by "
       "/"},
      {"[a, b]}}", "[a, b]}}\n    joint_source: {tf: a b}",
       "tools[1].joint_source.tf = a b, must be a text: no leading / and no blanks"},
      {"[a, b]}}", "[a, b]}}\n    joint_source: {tf: '', topic: joint_states}",
       "tools[1].joint_source: has topic, tf, must have exactly one of keyframes, topic, tf"},
      {"[a, b]}}", "[a, b]}}\n    joint_source: {keyframes: []}",
       "tools[1].joint_source.keyframes: is an empty list, must have at least 1"},
      {"[a, b]}}",
       "[a, b]}}\n    joint_source: {keyframes: [{time_s: 1, values_rad_or_m: {j: 0}}, "
       "{time_s: 1, values_rad_or_m: {j: 1}}]}",
       "tools[1].joint_source.keyframes[1].time_s = 1, must be above "
       "tools[1].joint_source.keyframes[0].time_s = 1"},
      {"[a, b]}}", "[a, b]}}\n    initial_joints_rad_or_m: [1]",
       "tools[1].initial_joints_rad_or_m = [1], must be a map of joints to numbers"},
      {"[a, b]}}", "[a, b]}}\n    initial_joints_rad_or_m: {j: far}",
       "tools[1].initial_joints_rad_or_m.j = far, must be a number in [-1000, 1000]"},
      {"[a, b]}}", "[a, b]}}\n    initial_joints_rad_or_m: {j: 2000}",
       "tools[1].initial_joints_rad_or_m.j = 2000, must be in [-1000, 1000]"},
      {"[a, b]}}", "[a, b]}}\n    initial_joints_rad_or_m: {j: 0, j: 1}",
       "tools[1].initial_joints_rad_or_m.j: is there twice"},
      {"[a, b]}}", "[a, b]}}\n    jaw: {joints: []}",
       "tools[1].jaw.joints: is an empty list, must have at least 1"},
      {"[a, b]}}", "[a, b]}}\n    jaw: {joints: [{joint: j, share: 0}]}",
       "tools[1].jaw.joints[0].share = 0, must be in [-10, 10] and not 0"},
      {"[a, b]}}", "[a, b]}}\n    max_speed_m_per_s: 0",
       "tools[1].max_speed_m_per_s = 0, must be in (0, 1000]"},
      {"[a, b]}}", "[a, b]}}\n    max_turn_rate_rad_per_s: -1",
       "tools[1].max_turn_rate_rad_per_s = -1, must be in (0, 1000]"},
      {"[a, b]}}", "[a, b]}}\n    pose_source: {marker: false}",
       "tools[1].pose_source.marker = false, must be true, or left out"},
      {URDF, "{sphere: {radius_m: 0.01}}\n    jaw: {joints: [{joint: j}]}",
       "tools[1].jaw: needs a shape from a urdf, which has joints"},
      {URDF, "{sphere: {radius_m: 0.01}}\n    joint_source: {topic: joint_states}",
       "tools[1].joint_source: needs a shape from a urdf, which has joints"},
      {URDF, "{sphere: {radius_m: 0.01}}\n    initial_joints_rad_or_m: {j: 0}",
       "tools[1].initial_joints_rad_or_m: needs a shape from a urdf, which has joints"},
      {URDF, "{sphere: {radius_m: 0.01}}\n    pose_source: {base: {}}",
       "tools[1].pose_source.base: needs a shape from a urdf, which has a root"},
  };
}

class BadJointsTest : public testing::TestWithParam<BadScene>
{
 protected:
  std::string good() const
  {
    return replaced(kGood,
                    "  - name: hook\n    shape: {mesh: {file: mesh.msh, length_unit: m, scale: [1, "
                    "1, 1]}}\n    pose_source: {topic: servo_cp}\n",
                    "  - name: hook\n    shape: " URDF "\n");
  }

  SceneFolder folder_;
};

TEST_P(BadJointsTest, AreAnsweredWithFileKeyValueAndWhatIsAllowed)
{
  const std::string text = replaced(good(), GetParam().from, GetParam().to);
  ASSERT_NE(text, good());
  EXPECT_EQ(complaintAbout(folder_, text), std::string("DIR/scene.yaml: ") + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(Joints, BadJointsTest, testing::ValuesIn(badJoints()));

TEST(JointSchema, EverythingArrives)
{
  const SceneFolder folder;
  const std::string tool =
      "  - name: hook\n    shape: {urdf: {file: mesh.msh, links: [a, b], frame: c}}\n"
      "    pose_source: {base: {position_m: [1, 2, 3]}}\n"
      "    max_speed_m_per_s: 0.2\n    max_turn_rate_rad_per_s: 3\n"
      "    initial_joints_rad_or_m: {roll: 0.5, slide: -0.01}\n"
      "    joint_source: {keyframes: [{time_s: 0, values_rad_or_m: {roll: 0}}, {time_s: 2, "
      "values_rad_or_m: {roll: 1}}]}\n"
      "    jaw: {joints: [{joint: left, share: 0.5}, {joint: right}], topic: grip}\n";
  const std::string text = replaced(
      kGood,
      "  - name: hook\n    shape: {mesh: {file: mesh.msh, length_unit: m, scale: [1, 1, 1]}}\n    "
      "pose_source: {topic: servo_cp}\n",
      tool);
  const SceneConfig scene = loadSceneConfig(folder.write("scene.yaml", text), &findPackage);
  const ToolConfig& hook = scene.tools.at(1);
  EXPECT_EQ(hook.urdf->links, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(hook.urdf->frame, "c");
  EXPECT_EQ(hook.pose_source.kind, PoseSourceConfig::Kind::base);
  EXPECT_EQ(hook.pose_source.base_pose.position_m, Vec3(1, 2, 3));
  EXPECT_EQ(hook.max_speed_m_per_s, 0.2);
  EXPECT_EQ(hook.max_turn_rate_rad_per_s, 3.0);
  ASSERT_EQ(hook.initial_joints.size(), 2u);
  EXPECT_EQ(hook.initial_joints[1].joint, "slide");
  EXPECT_EQ(hook.initial_joints[1].value, -0.01);
  EXPECT_EQ(hook.joint_source.kind, JointSourceConfig::Kind::keyframes);
  ASSERT_EQ(hook.joint_source.keyframes.size(), 2u);
  EXPECT_EQ(hook.joint_source.keyframes[1].values.at(0).value, 1.0);
  ASSERT_TRUE(hook.jaw.has_value());
  EXPECT_EQ(hook.jaw->topic, "grip");
  EXPECT_EQ(hook.jaw->joints.at(0).share, 0.5);
  EXPECT_EQ(hook.jaw->joints.at(1).share, JawJoint().share);
}

TEST(JointSchema, SourcesOfPosesArrive)
{
  const SceneFolder folder;
  const auto kindOf = [&](const std::string& source) {
    const std::string text = replaced(kGood, "{topic: servo_cp}", source);
    return loadSceneConfig(folder.write("scene.yaml", text), &findPackage)
        .tools.at(1)
        .pose_source.kind;
  };
  EXPECT_EQ(kindOf("marker"), PoseSourceConfig::Kind::marker);
  EXPECT_EQ(kindOf("{marker: true}"), PoseSourceConfig::Kind::marker);
  EXPECT_EQ(kindOf("{twist: servo_cv}"), PoseSourceConfig::Kind::twist);
  EXPECT_EQ(kindOf("{tf: tip}"), PoseSourceConfig::Kind::tf);
}

}  // namespace
}  // namespace soft_tissue
