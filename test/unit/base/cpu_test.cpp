#include "soft_tissue_sim/base/cpu.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr int kAccepted = 3;
constexpr int kRefused = 4;

/** Asks for the instruction set in a new process, where the environment has not been read yet. */
[[noreturn]] void askAndExit()
{
  try
  {
    std::fputs(name(instructionSet()), stderr);
    std::exit(kAccepted);
  }
  catch (const Error& error)
  {
    std::fputs(error.what(), stderr);
    std::exit(kRefused);
  }
}

/** Sets SOFT_TISSUE_ISA for one test; child processes are started anew, not forked. */
class Environment : public testing::Test
{
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
  void TearDown() override { unsetenv("SOFT_TISSUE_ISA"); }
  static void set(const char* value) { setenv("SOFT_TISSUE_ISA", value, 1); }
};

/** Asks the compiler's run time, not the library, which must not have been asked before a child
 * starts. */
bool machineHas(InstructionSet set)
{
#if defined(__x86_64__)
  return set == InstructionSet::baseline ||
         (set == InstructionSet::x86_64_v3 ? __builtin_cpu_supports("x86-64-v3")
                                           : __builtin_cpu_supports("x86-64-v4"));
#else
  return set == InstructionSet::baseline;
#endif
}

TEST(InstructionSets, haveNames)
{
  EXPECT_STREQ(name(InstructionSet::baseline), "baseline");
  EXPECT_STREQ(name(InstructionSet::x86_64_v3), "v3");
  EXPECT_STREQ(name(InstructionSet::x86_64_v4), "v4");
}

TEST(InstructionSets, baselineCanBeForcedEverywhere)
{
  const InstructionSet before = instructionSet();
  forceInstructionSet(InstructionSet::baseline);
  EXPECT_EQ(instructionSet(), InstructionSet::baseline);
  forceInstructionSet(before);
  EXPECT_EQ(instructionSet(), before);
}

TEST(InstructionSets, whatTheMachineLacksIsRefused)
{
  if (machineHas(InstructionSet::x86_64_v4))
  {
    GTEST_SKIP() << "this machine has every set";
  }
  const InstructionSet before = instructionSet();
  try
  {
    forceInstructionSet(InstructionSet::x86_64_v4);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("instruction set v4: this machine only has"),
              std::string::npos);
  }
  EXPECT_EQ(instructionSet(), before);
}

TEST_F(Environment, choosesASet)
{
  set("baseline");
  EXPECT_EXIT(askAndExit(), testing::ExitedWithCode(kAccepted), "^baseline$");
  if (machineHas(InstructionSet::x86_64_v3))
  {
    set("v3");
    EXPECT_EXIT(askAndExit(), testing::ExitedWithCode(kAccepted), "^v3$");
  }
}

TEST_F(Environment, emptyMeansTheBest)
{
  set("");
  const std::string best = machineHas(InstructionSet::x86_64_v4)   ? "^v4$"
                           : machineHas(InstructionSet::x86_64_v3) ? "^v3$"
                                                                   : "^baseline$";
  EXPECT_EXIT(askAndExit(), testing::ExitedWithCode(kAccepted), best);
}

TEST_F(Environment, unknownWordIsRefused)
{
  set("avx9");
  EXPECT_EXIT(askAndExit(), testing::ExitedWithCode(kRefused),
              "^SOFT_TISSUE_ISA = avx9, must be baseline, v3 or v4$");
}

TEST_F(Environment, whatTheMachineLacksIsRefused)
{
  if (machineHas(InstructionSet::x86_64_v4))
  {
    GTEST_SKIP() << "this machine has every set";
  }
  set("v4");
  EXPECT_EXIT(askAndExit(), testing::ExitedWithCode(kRefused),
              "^SOFT_TISSUE_ISA = v4: this machine only has (v3|baseline)$");
}

}  // namespace
}  // namespace soft_tissue
