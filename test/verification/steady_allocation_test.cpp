#include <execinfo.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"
#include "support/forceps.h"

// Every allocation of this program comes through here, whoever asks: C, C++ or a library.
extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_calloc(std::size_t, std::size_t);
extern "C" void* __libc_realloc(void*, std::size_t);
extern "C" void* __libc_memalign(std::size_t, std::size_t);

namespace
{
constexpr int kFrames = 24;
std::atomic<bool> g_counting{false};
std::atomic<int> g_allocations{0};
std::array<void*, kFrames> g_first_frames;
std::atomic<int> g_first_frame_count{0};

void count()
{
  if (!g_counting)
  {
    return;
  }
  if (g_allocations++ == 0)
  {
    g_counting = false;  // the backtrace itself may allocate
    g_first_frame_count = backtrace(g_first_frames.data(), kFrames);
    g_counting = true;
  }
}
}  // namespace

extern "C" void* malloc(std::size_t size)
{
  count();
  return __libc_malloc(size);
}

extern "C" void* calloc(std::size_t items, std::size_t size)
{
  count();
  return __libc_calloc(items, size);
}

extern "C" void* realloc(void* old, std::size_t size)
{
  count();
  return __libc_realloc(old, size);
}

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size)
{
  count();
  return __libc_memalign(alignment, size);
}

extern "C" int posix_memalign(void** result, std::size_t alignment, std::size_t size)
{
  count();
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}

namespace soft_tissue
{
namespace
{
/** Allocations while `work` runs. */
template <typename Work>
int allocationsOf(const Work& work)
{
  g_allocations = 0;
  g_counting = true;
  work();
  g_counting = false;
  return g_allocations;
}

/** Where the first of them came from. */
std::string firstCaller()
{
  char** names = backtrace_symbols(g_first_frames.data(), g_first_frame_count);
  std::string text;
  for (int i = 0; i < g_first_frame_count; ++i)
  {
    text += std::string(names[i]) + "\n";
  }
  std::free(names);
  return text;
}

std::string sourceFolder(const std::string&)
{
  return SOURCE_DIR;
}

constexpr double kPeriod = 0.4;    // s
constexpr double kStroke = 0.004;  // m
constexpr int kWarmUpPeriods = 4;
constexpr int kCountedPeriods = 2;

/** The ball of the smallest example, pressed into the lobe and rubbed to and fro. */
SceneConfig rubbedLobe()
{
  SceneConfig config = loadSceneConfig(SOURCE_DIR "/config/scenes/minimal.yaml", &sourceFolder);
  std::vector<PoseKeyframe>& keyframes = config.tools.at(0).pose_source.keyframes;
  PoseKeyframe pressed = keyframes.at(1);
  keyframes.assign(1, pressed);
  keyframes.front().time_s = 0.0;
  keyframes.front().pose.position_m.z() += 0.01;
  for (int half = 0; half <= 2 * (kWarmUpPeriods + kCountedPeriods); ++half)
  {
    pressed.time_s = 0.5 * kPeriod * (half + 1);
    pressed.pose.position_m.x() += half % 2 == 0 ? -kStroke : kStroke;
    keyframes.push_back(pressed);
  }
  return config;
}

class SteadyAllocation : public testing::TestWithParam<std::tuple<int, ElementKind, bool, Stepper>>
{
 protected:
  void SetUp() override { setThreadCount(std::get<0>(GetParam())); }
  void TearDown() override { setThreadCount(1); }
};

TEST_P(SteadyAllocation, aStepInContactAllocatesNothing)
{
  SceneConfig config = rubbedLobe();
  config.tissues.at(0).element = std::get<1>(GetParam());
  if (std::get<2>(GetParam()))
  {
    MaterialConfig& material = config.tissues[0].material;
    material.mass_damping_per_s = 1.0;
    material.stiffness_damping_s = 0.01;
    material.relaxation = {{0.5, 0.02}, {0.3, 1.0}};
    config.solver.tolerance = 1e-6;  // such smooth motion needs no iterations otherwise
  }
  config.solver.stepper = std::get<3>(GetParam());
  Scene scene(config);
  const double warm_s = (kWarmUpPeriods + 0.5) * kPeriod;
  const double end_s = warm_s + kCountedPeriods * kPeriod;
  Snapshot snapshot;
  while (scene.time() < warm_s)
  {
    scene.step();
    scene.fillSnapshot(snapshot);
  }
  while (scene.time() < end_s)
  {
    ASSERT_EQ(allocationsOf([&] { scene.step(); }), 0) << scene.time() << " s\n" << firstCaller();
    ASSERT_EQ(allocationsOf([&] { scene.fillSnapshot(snapshot); }), 0) << firstCaller();
    ASSERT_GT(snapshot.report.contacts, 0);
    ASSERT_GT(snapshot.report.newton_iterations, 0);
    ASSERT_FALSE(snapshot.report.held);
  }
}

INSTANTIATE_TEST_SUITE_P(
    AllKinds, SteadyAllocation,
    testing::Combine(testing::Values(1, 2),
                     testing::Values(ElementKind::tet4, ElementKind::tet4_anp, ElementKind::tet10),
                     testing::Bool(), testing::Values(Stepper::implicit_euler, Stepper::bdf2)));

TEST(SteadyAllocation, aStepThatSleepsAllocatesNothing)
{
  SceneConfig config = rubbedLobe();
  config.solver.sleep = SleepConfig{1e-3, 0.1, 0.0};
  config.tools.at(0).pose_source.keyframes.resize(1);
  Scene scene(config);
  while (scene.step().sleeping == 0)
  {
    ASSERT_LT(scene.time(), 10.0) << "never at rest";
  }
  Snapshot snapshot;
  scene.step();
  scene.fillSnapshot(snapshot);
  EXPECT_EQ(allocationsOf([&] { scene.step(); }), 0) << firstCaller();
  EXPECT_EQ(scene.step().sleeping, 1);
}

TEST(SteadyAllocation, aStepOfJawsThatHoldTissueAllocatesNothing)
{
  const test::ScratchFolder folder;
  SceneConfig config = test::blockScene(folder, {4, 4, 2});
  test::fixBelow(config, 1e-6);
  ToolConfig& forceps = test::addForceps(config, Vec3(0.0, 0.0, 0.02), 0.5);
  forceps.joint_source.kind = JointSourceConfig::Kind::keyframes;
  for (int half = 0; half <= 2 * (kWarmUpPeriods + kCountedPeriods); ++half)
  {
    const double value = half % 2 == 0 ? 0.003 : 0.005;
    forceps.joint_source.keyframes.push_back(
        {0.5 * kPeriod * (half + 1), {{"left", value}, {"right", value}}});
  }
  Scene scene(config);
  AttachRequest request;
  request.reach_m = 0.004;
  Snapshot snapshot;
  while (scene.time() < (kWarmUpPeriods + 0.5) * kPeriod)
  {
    scene.step();
    scene.fillSnapshot(snapshot);
    if (snapshot.tools[0].attached == 0)
    {
      ASSERT_GT(scene.attach(request), 0);
    }
  }
  while (scene.time() < (kWarmUpPeriods + kCountedPeriods) * kPeriod)
  {
    ASSERT_EQ(allocationsOf([&] { scene.step(); }), 0) << scene.time() << " s\n" << firstCaller();
    ASSERT_EQ(allocationsOf([&] { scene.fillSnapshot(snapshot); }), 0) << firstCaller();
    ASSERT_GT(snapshot.report.contacts, 0);
    ASSERT_GT(snapshot.tools[0].attached, 0);
  }
}

TEST(AllocationCounter, seesEveryKind)
{
  std::vector<int> numbers;
  EXPECT_EQ(allocationsOf([&] { numbers.resize(1000); }), 1);
  void* memory = nullptr;
  EXPECT_EQ(allocationsOf([&] { memory = std::malloc(64); }), 1);
  EXPECT_EQ(allocationsOf([&] { memory = std::realloc(memory, 1 << 20); }), 1);
  std::free(memory);
  EXPECT_EQ(allocationsOf([&] { memory = std::calloc(8, 8); }), 1);
  std::free(memory);
  EXPECT_EQ(allocationsOf([&] { memory = std::aligned_alloc(64, 64); }), 1);
  std::free(memory);
  EXPECT_EQ(allocationsOf([&] { EXPECT_EQ(posix_memalign(&memory, 64, 64), 0); }), 1);
  std::free(memory);
  EXPECT_EQ(allocationsOf([] {}), 0);
}

}  // namespace
}  // namespace soft_tissue
