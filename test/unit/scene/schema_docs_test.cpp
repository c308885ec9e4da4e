#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "scene_folder.h"

namespace soft_tissue
{
namespace
{
std::string readText(const std::string& file)
{
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/** UPDATE_DOCS=1 in the environment writes the file anew instead. */
TEST(SchemaDocsTest, DocsSceneMdIsWhatTheSchemaSays)
{
  const std::string file = SOURCE_DIR "/docs/scene.md";
  if (std::getenv("UPDATE_DOCS") != nullptr)
  {
    std::ofstream(file, std::ios::binary) << describeSchema();
  }
  EXPECT_EQ(readText(file), describeSchema())
      << "run this test with UPDATE_DOCS=1 and commit docs/scene.md";
}

/** The row of a key in the table of a section. */
std::string row(const std::string& section, const std::string& key)
{
  const std::string docs = describeSchema();
  const std::size_t begin = docs.find("\n## " + section + "\n");
  const std::size_t at = docs.find("\n| `" + key + "` |", begin);
  return at == std::string::npos ? "" : docs.substr(at + 1, docs.find('\n', at + 1) - at - 1);
}

TEST(SchemaDocsTest, RowsTellTypeUnitRangeDefaultAndMeaning)
{
  EXPECT_EQ(row("scene file", "time_step_s"),
            "| `time_step_s` | number | s | in (0, 1] | 0.005 | Simulated time of one step. |");
  EXPECT_EQ(
      row("contact", "stiffness_pa_per_m"),
      "| `stiffness_pa_per_m` | number or auto | Pa/m | in [1, 1e+15] | auto | Contact "
      "pressure per depth; auto: 20 E / R, E being the tissue's Young's modulus and R the "
      "radius of the largest ball inside the tool, half a cell of an obstacle; of two tissues, E "
      "of the softer one and the smaller R, of a tissue and a membrane the tissue's; of a "
      "membrane E t / R^2 in place of E / R, t being its thickness. |");
  EXPECT_EQ(row("capsule", "radius_m"),
            "| `radius_m` | number | m | in (0, 10) | **required** | Radius of the ball. |");
  EXPECT_EQ(
      row("tool", "pose_source"),
      "| `pose_source` | map or marker: [pose source](#pose-source) | | | {topic: servo_cp} | What "
      "moves it. |");
}

/** Scenes that come with the package, in a package of their own whose meshes are stand-ins. */
class ShippedScenesTest : public testing::TestWithParam<std::string>
{
 protected:
  ShippedScenesTest()
  {
    namespace fs = std::filesystem;
    fs::copy(SOURCE_DIR "/config", folder_.path() + "/config", fs::copy_options::recursive);
    fs::create_directories(folder_.path() + "/config/meshes");
    for (const char* mesh : {"lobe_1k", "lobe_5k", "lobe_20k"})
    {
      folder_.write(std::string("config/meshes/") + mesh + ".msh", "a stand-in");
    }
    package_ = folder_.path();
  }

  static std::string findStandIn(const std::string&) { return package_; }

  static std::string package_;
  SceneFolder folder_;
};

std::string ShippedScenesTest::package_;

TEST_P(ShippedScenesTest, IsRead)
{
  const SceneConfig scene =
      loadSceneConfig(folder_.path() + "/config/scenes/" + GetParam(), findStandIn);
  EXPECT_FALSE(scene.tissues.empty());
  EXPECT_EQ(scene.tools.size(), 1U);
  for (const TissueConfig& tissue : scene.tissues)
  {
    EXPECT_TRUE(std::any_of(scene.contacts.begin(), scene.contacts.end(),
                            [&](const ContactConfig& contact) {
                              return contact.tissue == tissue.name || contact.other == tissue.name;
                            }))
        << tissue.name << " touches nothing";
  }
}

std::vector<std::string> shippedScenes()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SOURCE_DIR "/config/scenes"))
  {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenesTest, testing::ValuesIn(shippedScenes()));

}  // namespace
}  // namespace soft_tissue
