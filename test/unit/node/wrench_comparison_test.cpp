#include "soft_tissue_sim/node/wrench_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Vec3;
using soft_tissue::Wrench;

WrenchPair pairOf(double time_s, const Vec3& measured, const Vec3& simulated)
{
  return {time_s, {measured, 0.1 * measured}, {simulated, 0.1 * simulated}};
}

TEST(WrenchErrors, areThoseOfAShortHistory)
{
  const WrenchErrors errors = errorsOf({pairOf(0.1, Vec3(3.0, 0.0, 4.0), Vec3(3.0, 0.0, 4.0)),
                                        pairOf(0.2, Vec3(0.0, 1.0, 0.0), Vec3(0.0, 3.0, 0.0))});
  EXPECT_EQ(errors.samples, 2u);
  EXPECT_NEAR(errors.measured_n, std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(errors.error_n, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(errors.greatest_error_n, 2.0);
  EXPECT_EQ(errors.greatest_error_time_s, 0.2);
  EXPECT_EQ(errors.mean_error_n, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(errors.measured_peak_n, 5.0);
  EXPECT_EQ(errors.simulated_peak_n, 5.0);
  EXPECT_NEAR(errors.error_nm, 0.1 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(errors.likeness, 28.0 / std::sqrt(26.0 * 34.0), 1e-12);
}

/** A tool that is turned by a right angle about z, with 2 N of tissue on it along y. */
soft_tissue::Snapshot turnedTool()
{
  soft_tissue::Snapshot snapshot;
  snapshot.report.time_s = 0.5;
  snapshot.tools.resize(1);
  snapshot.tools[0].X_WT.linear() = Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()).toRotationMatrix();
  snapshot.tools[0].wrench_W.force = Vec3(0.0, 2.0, 0.0);
  return snapshot;
}

TEST(WrenchComparison, turnsWhatWasMeasuredInTheToolsAxes)
{
  WrenchSeries series;
  series.topic = "/probe/body/measured_cf";
  series.in_tool_axes = true;
  series.times_s = {0.5};
  series.wrenches = {{Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.3)}};
  WrenchComparison comparison({"probe"}, {series});
  comparison.add(turnedTool());
  ASSERT_EQ(comparison.pairs(0).size(), 1u);
  EXPECT_NEAR(errorsOf(comparison.pairs(0)).error_n, 0.0, 1e-12);
  EXPECT_NE(comparison.text().find("probe against /probe/body/measured_cf"), std::string::npos);
}

TEST(WrenchComparison, noticesASensorThatTellsTheForceOnTheTissue)
{
  WrenchSeries series;
  series.topic = "/probe/spatial/measured_cf";
  series.times_s = {0.5};
  series.wrenches = {{Vec3(0.0, -2.0, 0.0), Vec3::Zero()}};
  WrenchComparison comparison({"probe"}, {series});
  comparison.add(turnedTool());
  EXPECT_NEAR(errorsOf(comparison.pairs(0)).error_n, 4.0, 1e-12);
  EXPECT_NE(comparison.text().find("against each other"), std::string::npos);
}

TEST(WrenchComparison, needsSomethingMeasured)
{
  EXPECT_THROW(WrenchComparison({"probe"}, std::vector<WrenchSeries>(1)), soft_tissue::Error);
}

}  // namespace
}  // namespace soft_tissue_sim
