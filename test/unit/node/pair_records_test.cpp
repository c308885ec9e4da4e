#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <soft_tissue_sim/SimStats.h>
#include <soft_tissue_sim/TissueContacts.h>
#include <soft_tissue_sim/ToolContacts.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Vec3;

constexpr std::size_t kSteps = 30;

/** What the messages of one step tell of the pair. */
struct Sums
{
  Vec3 force = Vec3::Zero();
  double deepest = 0.0;
  std::size_t points = 0;
};

/** Runs a cube that falls onto a block; a tool called `contacts` hangs beside it. */
class PairRecords : public testing::Test
{
 protected:
  PairRecords()
  {
    const std::string scene = folder_.path() + "/scene.yaml";
    std::ofstream(scene)
        << "time_step_s: 0.01\n"
           "tissues:\n"
           "  - name: bed\n"
           "    mesh: {file: " SOURCE_DIR
           "/test/ros/block.msh, length_unit: m}\n"
           "    material: &soft {model: neo_hookean, young_modulus_pa: 5000, poisson_ratio: 0.4,\n"
           "                     density_kg_per_m3: 1000}\n"
           "    fixed: [{box_m: [[-1, -1, -0.001], [1, 1, 0.001]]}]\n"
           "  - name: cube\n"
           "    mesh: {file: " SOURCE_DIR
           "/test/ros/cube.msh, length_unit: m}\n"
           "    pose: {position_m: [-0.01, -0.01, 0.032]}\n"
           "    material: *soft\n"
           "tools:\n"
           "  - name: contacts\n"
           "    shape: {sphere: {radius_m: 0.008}}\n"
           "    pose_source:\n"
           "      keyframes:\n"
           "        - {time_s: 0, position_m: [0, 0, 0.2]}\n"
           "        - {time_s: 0.3, position_m: [0, 0, 0.2]}\n"
           "contacts:\n"
           "  - {between: [cube, bed]}\n"
           "  - {between: [cube, contacts]}\n";
    RunOptions options;
    options.scene = scene;
    options.quiet = true;
    options.threads = 1;
    options.bag_out = folder_.path() + "/run.bag";
    options.csv = folder_.path() + "/run.csv";
    options.json = folder_.path() + "/run.json";
    runScene(options);
    readBag(options.bag_out);
    readCsv(options.csv);
    std::ifstream json(options.json);
    json_.assign(std::istreambuf_iterator<char>(json), {});
  }

  void readBag(const std::string& path)
  {
    rosbag::Bag bag(path);
    for (const rosbag::MessageInstance& message : rosbag::View(bag))
    {
      const std::string& topic = message.getTopic();
      if (const auto stats = message.instantiate<SimStats>())
      {
        counted_.push_back(stats->contacts);
      }
      if (const auto contacts = message.instantiate<TissueContacts>())
      {
        EXPECT_EQ(topic, "/sim_node/contacts");
        Sums& step = from_bag_.emplace_back();
        step.points = contacts->points.size();
        for (std::size_t i = 0; i < step.points; ++i)
        {
          const geometry_msgs::Vector3& force = contacts->forces[i];
          step.force += Vec3(force.x, force.y, force.z);
          step.deepest = std::max(step.deepest, contacts->depths[i]);
        }
      }
      if (message.instantiate<ToolContacts>())
      {
        EXPECT_EQ(topic, "/sim_node/contacts/contacts");
        ++tool_messages_;
      }
    }
  }

  void readCsv(const std::string& path)
  {
    const auto cells = [](const std::string& line) {
      std::vector<std::string> found;
      std::istringstream stream(line);
      for (std::string cell; std::getline(stream, cell, ',');)
      {
        found.push_back(cell);
      }
      return found;
    };
    std::ifstream stream(path);
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> names = cells(line);
    while (std::getline(stream, line))
    {
      const std::vector<std::string> values = cells(line);
      ASSERT_EQ(values.size(), names.size());
      auto& row = from_csv_.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i)
      {
        EXPECT_TRUE(row.emplace(names[i], values[i]).second) << names[i] << " twice";
      }
    }
  }

  double csv(std::size_t step, const std::string& column) const
  {
    return std::stod(from_csv_[step].at("cube/bed_" + column));
  }

  /** A number of the only pair's object in the summary. */
  double json(const std::string& key) const
  {
    const std::size_t pairs = json_.find("\"tissue_pairs\": [");
    const std::size_t at = json_.find("\"" + key + "\": ", pairs);
    return at == std::string::npos ? -1.0 : std::stod(json_.substr(json_.find(':', at) + 1));
  }

  ScratchFolder folder_;
  std::vector<Sums> from_bag_;
  std::vector<std::uint32_t> counted_;
  std::size_t tool_messages_ = 0;
  std::vector<std::map<std::string, std::string>> from_csv_;
  std::string json_;
};

TEST_F(PairRecords, ofBagTableAndSummaryAgree)
{
  ASSERT_EQ(from_bag_.size(), kSteps);
  ASSERT_EQ(from_csv_.size(), kSteps);
  EXPECT_EQ(tool_messages_, kSteps);  // beside the pairs' topic, of which its name is a part
  Sums most;
  double peak = 0.0, sum = 0.0;
  for (std::size_t step = 0; step < kSteps; ++step)
  {
    const Sums& expected = from_bag_[step];
    const Vec3 force(csv(step, "force_x_n"), csv(step, "force_y_n"), csv(step, "force_z_n"));
    EXPECT_LT((force - expected.force).norm(), 1e-15) << "step " << step;
    EXPECT_EQ(csv(step, "depth_m"), expected.deepest);
    EXPECT_EQ(csv(step, "contacts"), static_cast<double>(expected.points));
    EXPECT_EQ(counted_[step], expected.points);
    peak = std::max(peak, expected.force.norm());
    sum += expected.force.norm();
    most.deepest = std::max(most.deepest, expected.deepest);
    most.points = std::max(most.points, expected.points);
  }
  EXPECT_EQ(from_bag_.front().points, 0u);
  EXPECT_GT(from_bag_.back().force.z(), 0.0);
  EXPECT_NE(json_.find("\"first\": \"cube\",\n      \"second\": \"bed\""), std::string::npos);
  EXPECT_NEAR(json("peak_force_n"), peak, 1e-15);
  EXPECT_NEAR(json("mean_force_n"), sum / kSteps, 1e-15);
  EXPECT_EQ(json("most_contacts"), static_cast<double>(most.points));
  EXPECT_EQ(json("max_penetration_m"), most.deepest);
  EXPECT_NEAR(json("last_force_z_n"), from_bag_.back().force.z(), 1e-15);
}

}  // namespace
}  // namespace soft_tissue_sim
