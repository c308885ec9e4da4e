#include "soft_tissue_sim/node/identification.h"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <limits>
#include <random>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "support/pressed_block.h"

namespace soft_tissue_sim
{
namespace
{
using namespace test;

constexpr double kTrueModulus = 5000.0, kTrueStiffness = 2e6;
const std::string kStiffness = ", stiffness_pa_per_m: ";

class Identification : public testing::Test
{
 protected:
  /** Presses the block. */
  void SetUp() override
  {
    pressed_.write(kTrueModulus, kPressingKeyframes, kStiffness + std::to_string(kTrueStiffness));
    const RunOptions run = pressed_.options("true");
    runScene(run);
    pressed_bag_ = run.bag_out;
  }

  /** Its bag, with this much noise in the forces, N. */
  std::string record(double noise_n, unsigned seed) const
  {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, noise_n);
    const std::string noisy = pressed_.path("noisy.bag");
    rosbag::Bag in(pressed_bag_), out(noisy, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in))
    {
      if (const auto wrench = message.instantiate<geometry_msgs::WrenchStamped>())
      {
        geometry_msgs::WrenchStamped measured = *wrench;
        measured.wrench.force.x += normal(random);
        measured.wrench.force.y += normal(random);
        measured.wrench.force.z += normal(random);
        out.write(message.getTopic(), message.getTime(), measured);
      }
      else
      {
        out.write(message.getTopic(), message.getTime(), message);
      }
    }
    return noisy;
  }

  /** The JSON of a fit that starts elsewhere. */
  std::string fit(const std::string& bag, const std::vector<std::string>& names, double modulus_pa,
                  double stiffness_pa_per_m)
  {
    pressed_.write(modulus_pa, kPressingTopic, kStiffness + std::to_string(stiffness_pa_per_m));
    RunOptions options;
    options.scene = pressed_.scene();
    options.bag_in = bag;
    options.json = pressed_.path("fit.json");
    options.quiet = true;
    options.identify = names;
    identifyParameters(options);
    return PressedBlock::contents(options.json);
  }

  /** The number-th value of a key. */
  static double valueOf(const std::string& json, const std::string& key, int number = 0)
  {
    const std::string quoted = "\"" + key + "\": ";
    std::size_t at = json.find(quoted);
    for (; number > 0 && at != std::string::npos; --number)
    {
      at = json.find(quoted, at + 1);
    }
    return at == std::string::npos ? std::numeric_limits<double>::quiet_NaN()
                                   : std::stod(json.substr(at + quoted.size()));
  }

  PressedBlock pressed_;
  std::string pressed_bag_;
};

TEST_F(Identification, findsTheModulusThatMadeTheForces)
{
  const std::string json = fit(record(0.0, 0), {"block/young_modulus_pa"}, 1500.0, kTrueStiffness);
  std::printf("  from 1500 Pa to %.1f Pa, 95 %% between %.1f and %.1f, %.0f replays\n",
              valueOf(json, "value"), valueOf(json, "low"), valueOf(json, "high"),
              valueOf(json, "replays"));
  EXPECT_NE(json.find("\"converged\": true"), std::string::npos) << json;
  EXPECT_NEAR(valueOf(json, "value"), kTrueModulus, 0.01 * kTrueModulus);
  EXPECT_LT(valueOf(json, "error_rms_n"), 0.02 * valueOf(json, "error_rms_before_n"));
}

TEST_F(Identification, tellsTissueFromContact)
{
  const std::string json = fit(
      record(0.0, 0), {"block/young_modulus_pa", "block/probe/stiffness_pa_per_m"}, 8000.0, 1e6);
  std::printf("  %.1f Pa, %.4g Pa/m, %.0f replays\n", valueOf(json, "value"),
              valueOf(json, "value", 1), valueOf(json, "replays"));
  EXPECT_NEAR(valueOf(json, "value"), kTrueModulus, 0.02 * kTrueModulus);
  EXPECT_NEAR(valueOf(json, "value", 1), kTrueStiffness, 0.1 * kTrueStiffness);
}

TEST_F(Identification, saysHowSureItIs)
{
  int caught = 0;
  constexpr int kTrials = 20;
  double width = 0.0;
  for (unsigned seed = 1; seed <= kTrials; ++seed)
  {
    const std::string json =
        fit(record(0.002, seed), {"block/young_modulus_pa"}, 4000.0, kTrueStiffness);
    const double low = valueOf(json, "low"), high = valueOf(json, "high");
    caught += low <= kTrueModulus && kTrueModulus <= high ? 1 : 0;
    width += (high - low) / kTrials;
  }
  std::printf("  %d of %d intervals, %.0f Pa wide in the mean, hold the truth\n", caught, kTrials,
              width);
  EXPECT_GE(caught, 15);
  EXPECT_GT(width, 0.001 * kTrueModulus);
  EXPECT_LT(width, 0.2 * kTrueModulus);
}

TEST_F(Identification, refusesWhatItCannotFit)
{
  const std::string bag = record(0.0, 0);
  EXPECT_THROW(fit(bag, {"block/colour"}, 5000.0, 1e6), soft_tissue::Error);
  EXPECT_THROW(fit(bag, {"liver/young_modulus_pa"}, 5000.0, 1e6), soft_tissue::Error);
  EXPECT_THROW(fit(bag, {"block/stiffening"}, 5000.0, 1e6), soft_tissue::Error);
  EXPECT_THROW(fit(pressed_.scene(), {"block/young_modulus_pa"}, 5000.0, 1e6), soft_tissue::Error);
}

}  // namespace
}  // namespace soft_tissue_sim
