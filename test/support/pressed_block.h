#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "soft_tissue_sim/node/run_options.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim::test
{
constexpr int kPressedSteps = 40;
constexpr const char* kPressingKeyframes =
    "    pose_source:\n"
    "      keyframes:\n"
    "        - {time_s: 0, position_m: [0, 0, 0.04]}\n"
    "        - {time_s: 0.4, position_m: [0, 0, 0.035]}\n";
constexpr const char* kPressingTopic = "    pose_source: {topic: servo_cp}\n";

/** A folder with the scene of a ball, `probe`, that is pressed on a block, `block`. */
class PressedBlock
{
 public:
  PressedBlock() { write(5000.0, kPressingKeyframes); }

  /** Of Young's modulus in Pa, moved by the lines of YAML given. */
  void write(double young_modulus_pa, const std::string& pose_source,
             const std::string& contact = "")
  {
    std::ofstream(scene()) << "time_step_s: 0.01\n"
                              "tissues:\n"
                              "  - name: block\n"
                              "    mesh: {file: " SOURCE_DIR
                              "/test/ros/block.msh, length_unit: m}\n"
                              "    material: {model: neo_hookean, young_modulus_pa: "
                           << young_modulus_pa
                           << ", poisson_ratio: 0.4,\n"
                              "               density_kg_per_m3: 1000}\n"
                              "    fixed: [{box_m: [[-1, -1, -0.001], [1, 1, 0.001]]}]\n"
                              "tools:\n"
                              "  - name: probe\n"
                              "    shape: {sphere: {radius_m: 0.008}}\n"
                           << pose_source << "contacts: [{between: [block, probe]" << contact
                           << "}]\n";
  }

  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }
  std::string scene() const { return path("scene.yaml"); }

  /** Writes NAME.bag, NAME.csv and NAME.json. */
  RunOptions options(const std::string& name) const
  {
    RunOptions options;
    options.scene = scene();
    options.quiet = true;
    options.bag_out = path(name + ".bag");
    options.csv = path(name + ".csv");
    options.json = path(name + ".json");
    return options;
  }

  static std::string contents(const std::string& path)
  {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

 private:
  ScratchFolder folder_;
};

}  // namespace soft_tissue_sim::test
