#include <sys/stat.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "contact_study.h"
#include "feature_cost.h"
#include "fem_study.h"
#include "field_study.h"
#include "stability_study.h"

namespace
{
constexpr const char* kUsage =
    "usage: speed_error field|contact|fem|stability|features --out DIR [--quick]\n"
    "  field    distance fields: DIR/field.csv; rosrun soft_tissue_sim plot_speed_error.py DIR\n"
    "           draws it\n"
    "  contact  forces on tools against contact mechanics: DIR/contact.csv; finding who touches\n"
    "           whom: DIR/detection.csv\n"
    "  fem      the step without contact beside a plain one: DIR/fem_race.csv; beside Bullet:\n"
    "           DIR/fem_bullet.csv; with two threads beside one: DIR/fem_threads.csv; its shares\n"
    "           of bandwidth: DIR/fem_roofline.csv; speed against error of elements, laws,\n"
    "           solvers: DIR/fem.csv, drawn by plot_speed_error.py\n"
    "  stability  hard cases, how each ends: DIR/stability.csv\n"
    "  features   what a step costs with each feature off, idle, in use: DIR/features.csv\n"
    "  --quick  small bodies only, each timed once\n";

using Study = void (*)(const std::string& folder, bool quick);

Study studyNamed(const std::string& name)
{
  return name == "field"       ? soft_tissue::studies::studyFields
         : name == "contact"   ? soft_tissue::studies::studyContact
         : name == "fem"       ? soft_tissue::studies::studyFem
         : name == "stability" ? soft_tissue::studies::studyStability
         : name == "features"  ? soft_tissue::studies::studyFeatures
                               : nullptr;
}
}  // namespace

int main(int argc, char** argv)
{
  std::string folder;
  Study study = nullptr;
  bool quick = false, known = argc > 1;
  for (int i = 1; i < argc && known; ++i)
  {
    if (std::strcmp(argv[i], "--out") == 0 && i + 1 < argc)
    {
      folder = argv[++i];
    }
    else if (std::strcmp(argv[i], "--quick") == 0)
    {
      quick = true;
    }
    else
    {
      known = study == nullptr && studyNamed(argv[i]) != nullptr;
      study = studyNamed(argv[i]);
    }
  }
  if (!known || study == nullptr || folder.empty())
  {
    std::fprintf(stderr, "%s", kUsage);
    return argc == 2 && std::strcmp(argv[1], "--help") == 0 ? 0 : 2;
  }
  try
  {
    mkdir(folder.c_str(), 0777);  // what went wrong shows when the file is opened
    study(folder, quick);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "speed_error: %s\n", error.what());
    return 1;
  }
  return 0;
}
