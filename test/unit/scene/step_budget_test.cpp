#include "soft_tissue_sim/scene/step_budget.h"

#include <gtest/gtest.h>

#include <cmath>

namespace soft_tissue
{
namespace
{
TEST(BudgetShares, IsSharedByPartsThatUseAllOfTheirs)
{
  StepBudget budget;
  budget.begin(0.008);
  double now = 0.0;
  for (int part = 0; part < 4; ++part)
  {
    budget.beginPart(0.25 * part, 0.25 * (part + 1), now);
    EXPECT_NEAR(budget.left(now), 0.002, 1e-15) << part;
    now += budget.left(now);
  }
  EXPECT_NEAR(now, 0.008, 1e-15);
}

TEST(BudgetShares, LeavesToLaterPartsWhatEarlierOnesDidNotNeed)
{
  StepBudget budget;
  budget.begin(0.008);
  budget.beginPart(0.0, 0.25, 0.0);
  budget.beginPart(0.25, 0.5, 0.0005);
  EXPECT_NEAR(budget.left(0.0005), 0.0025, 1e-15);
  EXPECT_NEAR(budget.left(0.001), 0.002, 1e-15);
}

TEST(BudgetShares, TakesFromLaterPartsWhatEarlierOnesTookTooMuch)
{
  StepBudget budget;
  budget.begin(0.008);
  budget.beginPart(0.5, 0.75, 0.006);
  EXPECT_NEAR(budget.left(0.006), 0.001, 1e-15);
  budget.beginPart(0.75, 1.0, 0.009);
  EXPECT_NEAR(budget.left(0.009), -0.001, 1e-15);
}

TEST(BudgetShares, GivesHalvesOfAPartTheirShare)
{
  StepBudget budget;
  budget.begin(0.008);
  budget.beginPart(0.5, 0.625, 0.004);
  EXPECT_NEAR(budget.left(0.004), 0.001, 1e-15);
}

TEST(BudgetShares, IsWithoutEndWhereNoneIsNamed)
{
  StepBudget budget;
  budget.begin(std::nullopt);
  budget.beginPart(0.5, 1.0, 3.0);
  EXPECT_TRUE(std::isinf(budget.left(1e9)));
}

}  // namespace
}  // namespace soft_tissue
