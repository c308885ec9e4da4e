#include "soft_tissue_sim/node/run_options.h"

#include <gtest/gtest.h>

namespace soft_tissue_sim
{
namespace
{
TEST(RunOptions, readsEveryOption)
{
  const RunOptions options =
      parseRunOptions({"a.yaml", "--duration",   "2.5",   "--bag-in",  "i.bag",     "--bag-out",
                       "o.bag",  "--csv",        "c.csv", "--json",    "j.json",    "--load-state",
                       "l",      "--save-state", "s",     "--threads", "3",         "--state-rate",
                       "0",      "--frame-id",   "base",  "--quiet",   "--compare", "f.csv",
                       "--tare", "0.5"});
  EXPECT_EQ(options.scene, "a.yaml");
  EXPECT_EQ(options.duration_s, 2.5);
  EXPECT_EQ(options.bag_in, "i.bag");
  EXPECT_EQ(options.bag_out, "o.bag");
  EXPECT_EQ(options.csv, "c.csv");
  EXPECT_EQ(options.json, "j.json");
  EXPECT_EQ(options.load_state, "l");
  EXPECT_EQ(options.save_state, "s");
  EXPECT_EQ(options.threads, 3);
  EXPECT_EQ(options.state_rate_hz, 0.0);
  EXPECT_EQ(options.world_frame, "base");
  EXPECT_TRUE(options.quiet);
  EXPECT_EQ(options.compare, "f.csv");
  EXPECT_EQ(options.tare_s, 0.5);
  EXPECT_TRUE(parseRunOptions({"a.yaml", "--bag-in", "i.bag", "--list-inputs"}).list_inputs);
  const std::vector<std::string> names = {"liver/young_modulus_pa", "liver/probe/friction"};
  EXPECT_EQ(
      parseRunOptions({"a.yaml", "--bag-in", "i.bag", "--identify", names[0] + "," + names[1]})
          .identify,
      names);
}

TEST(RunOptions, needsNoSceneToExplainItself)
{
  EXPECT_TRUE(parseRunOptions({"--help"}).help);
  EXPECT_TRUE(parseRunOptions({"--describe-schema"}).describe_schema);
}

TEST(RunOptions, refusesWhatItCannotUnderstand)
{
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--quiet"},
      {"a.yaml", "b.yaml"},
      {"a.yaml", "--speed"},
      {"a.yaml", "--duration"},
      {"a.yaml", "--duration", "long"},
      {"a.yaml", "--duration", "1s"},
      {"a.yaml", "--duration", "-1"},
      {"a.yaml", "--duration", "nan"},
      {"a.yaml", "--threads", "1.5"},
      {"a.yaml", "--threads", "-1"},
      {"a.yaml", "--compare", "c.csv"},
      {"a.yaml", "--identify", "a/b"},
      {"a.yaml", "--list-inputs"},
      {"a.yaml", "--bag-in", "i.bag", "--identify", "a/b", "--csv", "c.csv"}};
  for (const auto& arguments : wrong)
  {
    EXPECT_THROW(parseRunOptions(arguments), UsageError)
        << (arguments.empty() ? "" : arguments.back());
  }
}

}  // namespace
}  // namespace soft_tissue_sim
