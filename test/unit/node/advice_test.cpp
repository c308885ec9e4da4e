#include "soft_tissue_sim/node/advice.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace soft_tissue_sim
{
namespace
{
TEST(Advice, TellsTheWorstTroubleOfAStep)
{
  soft_tissue::StepReport report;
  report.converged = true;
  EXPECT_EQ(troubleOf(report, false), StepTrouble::none);
  report.converged = false;
  report.out_of_time = true;  // as a budget wants it
  EXPECT_EQ(troubleOf(report, false), StepTrouble::none);
  report.out_of_time = false;
  EXPECT_EQ(troubleOf(report, false), StepTrouble::not_converged);
  report.min_det_f = -0.1;
  EXPECT_EQ(troubleOf(report, false), StepTrouble::inverted);
  EXPECT_EQ(troubleOf(report, true), StepTrouble::late);
  report.held = true;
  EXPECT_EQ(troubleOf(report, true), StepTrouble::held);
}

TEST(Advice, IsOneOfItsOwnForEachTrouble)
{
  std::set<std::string> said;
  for (const StepTrouble trouble :
       {StepTrouble::held, StepTrouble::late, StepTrouble::inverted, StepTrouble::not_converged})
  {
    EXPECT_TRUE(said.insert(adviceFor(trouble)).second);
    EXPECT_TRUE(said.insert(troubleText(trouble)).second);
  }
  for (int rejection = 1; rejection < kRejectionCount; ++rejection)
  {
    EXPECT_TRUE(said.insert(adviceFor(static_cast<Rejection>(rejection))).second) << rejection;
  }
  EXPECT_EQ(said.count(""), 0u);
  EXPECT_STREQ(adviceFor(StepTrouble::none), "");
  EXPECT_STREQ(adviceFor(Rejection::none), "");
}

}  // namespace
}  // namespace soft_tissue_sim
