#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/energy/mass_terms.h"

namespace soft_tissue
{
namespace
{
// The parabola through three times has the slope that the formula finds, whatever the times.
TEST(StepFormula, OfBdf2IsExactForParabolas)
{
  for (const double ratio : {1e-3, 0.3, 1.0, 2.0, 10.0})
  {
    const double last_s = 0.7, step_s = ratio * last_s;
    const StepFormula formula = StepFormula::bdf2(step_s, last_s);
    const auto x = [](double t) { return 2.0 - 3.0 * t + 5.0 * t * t; };
    const double carried = x(0.0) + formula.carried * (x(0.0) - x(-last_s));
    const double slope = (x(step_s) - carried) / formula.effective_s;
    EXPECT_NEAR(slope, -3.0 + 10.0 * step_s, 1e-11 * (3.0 + 10.0 * step_s)) << ratio;
  }
}

TEST(StepFormula, OfEqualStepsHasTheCoefficientsOfEveryTextbook)
{
  const StepFormula formula = StepFormula::bdf2(0.5, 0.5);
  EXPECT_NEAR(formula.effective_s, 2.0 / 3.0 * 0.5, 1e-16);
  EXPECT_NEAR(formula.carried, 1.0 / 3.0, 1e-16);
}

TEST(StepFormula, OfImplicitEulerHasNoPast)
{
  EXPECT_EQ(StepFormula::implicitEuler(0.25).effective_s, 0.25);
  EXPECT_EQ(StepFormula::implicitEuler(0.25).carried, 0.0);
}

/** Two tissues of one node each, of which the second goes on by another formula. */
class TwoFormulas : public testing::Test
{
 protected:
  const std::vector<double> masses_ = {2.0, 3.0};
  const Points x_ = {{1, 2, 3}, {-1, 0, 2}}, v_ = {{0.5, 0, 1}, {2, -1, 0}};
  const Points x_last_ = {{0.9, 2, 2.5}, {0, 0, 1}}, v_last_ = {{1, 1, 1}, {0, 3, 0}};
  const StepStart start_{x_, v_, x_last_, v_last_};
  const StepFormula euler_ = StepFormula::implicitEuler(0.1), bdf2_ = StepFormula::bdf2(0.1, 0.2);
};

TEST_F(TwoFormulas, AreMinimisedTogether)
{
  Inertia inertia(masses_);
  inertia.beginStep(0, 1, start_, euler_);
  inertia.beginStep(1, 1, start_, bdf2_);
  EXPECT_LT((inertia.target()[0] - (x_[0] + 0.1 * v_[0])).norm(), 1e-15);
  // By the variable-step formula in its usual form, r = 1/2.
  const double s = 0.1 * 1.5 / 2.0;
  const Vec3 position = (1.5 * 1.5 * x_[1] - 0.25 * x_last_[1]) / 2.0;
  const Vec3 velocity = (1.5 * 1.5 * v_[1] - 0.25 * v_last_[1]) / 2.0;
  EXPECT_LT((inertia.target()[1] - (position + s * velocity)).norm(), 1e-15);

  const Points x = {{1.5, 0, 0}, {0, 1, 0}};
  const Vec3 off[] = {x[0] - inertia.target()[0], x[1] - inertia.target()[1]};
  const double value =
      0.5 * 2.0 / 0.01 * off[0].squaredNorm() + 0.5 * 3.0 / (s * s) * off[1].squaredNorm();
  EXPECT_NEAR(inertia.value(x), value, 1e-12 * value);
  Points gradient(2, Vec3::Zero());
  inertia.addGradient(x, gradient);
  EXPECT_LT((gradient[0] - 2.0 / 0.01 * off[0]).norm(), 1e-12 * gradient[0].norm());
  EXPECT_LT((gradient[1] - 3.0 / (s * s) * off[1]).norm(), 1e-12 * gradient[1].norm());
}

TEST_F(TwoFormulas, TellWhetherTheSecondDerivativeChanges)
{
  Inertia inertia(masses_);
  EXPECT_TRUE(inertia.beginStep(0, 2, start_, euler_));
  EXPECT_FALSE(inertia.beginStep(0, 2, start_, euler_));
  EXPECT_TRUE(inertia.beginStep(1, 1, start_, bdf2_));
  EXPECT_FALSE(inertia.beginStep(0, 1, start_, euler_));
}

}  // namespace
}  // namespace soft_tissue
