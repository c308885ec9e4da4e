#include <gtest/gtest.h>

#include <functional>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/hash.h"
#include "soft_tissue_sim/base/state_archive.h"
#include "support/state_scenes.h"

namespace soft_tissue::test
{
namespace
{
TEST(StateFile, OfASceneThatHasNotBegun)
{
  const ScratchFolder folder;
  const SceneConfig config = stroked(folder);
  Scene scene(config), other(config);
  scene.saveState(folder.path("state"));
  for (int k = 0; k < 5; ++k)
  {
    other.step();
  }
  other.loadState(folder.path("state"));
  expectSame(scene, other);
  scene.step();
  other.step();
  expectSame(scene, other);
}

/** What loading a file complains of, its name as FILE; nothing may have changed by that. */
std::string complaint(Scene& scene, const std::string& file)
{
  const std::uint64_t before = scene.stateHash();
  std::string text = "none";
  try
  {
    scene.loadState(file);
  }
  catch (const Error& error)
  {
    text = error.what();
    EXPECT_EQ(scene.stateHash(), before);
    const std::size_t at = text.find(file);
    text = at == std::string::npos ? text : text.replace(at, file.size(), "FILE");
  }
  return text;
}

TEST(StateFile, OfAnotherSceneOrDamagedIsRefusedAndNothingChanges)
{
  const ScratchFolder folder;
  const SceneConfig config = stroked(folder);
  Scene scene(config), untouched(config);
  const std::string file = folder.path("state");
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
    untouched.step();
  }
  scene.saveState(file);
  const std::string good = readBytes(file);
  EXPECT_EQ(complaint(scene, folder.path("gone")), "FILE: can't be read");
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{9}, good.size() / 2, good.size() - 1})
  {
    writeBytes(folder.path("cut"), good.substr(0, length));
    const std::string said = complaint(scene, folder.path("cut"));
    EXPECT_TRUE(said == "state FILE is no saved state" ||
                said ==
                    "state FILE is damaged: its checksum is not that of what it holds; "
                    "truncated?")
        << said;
  }
  std::string flipped = good;
  flipped[good.size() / 3] ^= 4;
  writeBytes(folder.path("flipped"), flipped);
  EXPECT_EQ(complaint(scene, folder.path("flipped")),
            "state FILE is damaged: its checksum is not that of what it holds; truncated?");
  for (const auto& change : std::vector<std::function<void(SceneConfig&)>>{
           [](SceneConfig& c) { c.time_step_s = 0.02; },
           [](SceneConfig& c) { c.contacts[0].friction = 0.1; },
           [](SceneConfig& c) {
             c.tools[0].name = "probe";
             c.contacts[0].other = "probe";
           },
           [](SceneConfig& c) { c.tissues[0].pose.position_m.x() += 1e-9; },
           [](SceneConfig& c) { c.solver.stepper = Stepper::bdf2; }})
  {
    SceneConfig other = config;
    change(other);
    Scene another(other);
    EXPECT_EQ(complaint(another, file), "state FILE is the state of another scene");
  }
  scene.step();
  untouched.step();
  expectSame(scene, untouched);
}

// Its checksum is right, and what it is a state of.
TEST(StateFile, ThatFitsNotToTheEndLeavesTheSceneAsItWas)
{
  const ScratchFolder folder;
  SceneConfig config = stroked(folder);
  Scene scene(config), untouched(config);
  for (int k = 0; k < 8; ++k)
  {
    scene.step();
    untouched.step();
  }
  // Another name for the section that is read last, and the sum right again.
  scene.saveState(folder.path("state"));
  std::string bytes = readBytes(folder.path("state"));
  const std::size_t at = bytes.find("report");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 6, "repert");
  bytes.resize(bytes.size() - 8);
  StateHash hash;
  hash.add(bytes.data(), bytes.size());
  const std::uint64_t sum = hash.value();
  bytes.append(reinterpret_cast<const char*>(&sum), 8);
  writeBytes(folder.path("bad"), bytes);
  EXPECT_EQ(complaint(scene, folder.path("bad")), "state FILE has no section 'report'");
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
    untouched.step();
    expectSame(scene, untouched);
  }
}

TEST(StateFile, CanNotBeWrittenWhereThereIsNoFolder)
{
  const ScratchFolder folder;
  const Scene scene(stroked(folder));
  EXPECT_THROW(scene.saveState(folder.path("gone") + "/state"), Error);
}

}  // namespace
}  // namespace soft_tissue::test
