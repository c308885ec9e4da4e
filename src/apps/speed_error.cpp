#include <sys/stat.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "field_study.h"

namespace
{
constexpr const char* kUsage =
    "usage: speed_error field --out DIR [--quick]\n"
    "  field    distance fields: DIR/field.csv; rosrun soft_tissue_sim plot_speed_error.py DIR\n"
    "           draws it\n"
    "  --quick  small bodies only, each timed once\n";
}

int main(int argc, char** argv)
{
  std::string study, folder;
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
      known = study.empty() && std::strcmp(argv[i], "field") == 0;
      study = argv[i];
    }
  }
  if (!known || study.empty() || folder.empty())
  {
    std::fprintf(stderr, "%s", kUsage);
    return argc == 2 && std::strcmp(argv[1], "--help") == 0 ? 0 : 2;
  }
  try
  {
    mkdir(folder.c_str(), 0777);  // what went wrong shows when the file is opened
    soft_tissue::studies::studyFields(folder, quick);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "speed_error: %s\n", error.what());
    return 1;
  }
  return 0;
}
