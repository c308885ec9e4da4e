#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "hard_cases.h"
#include "support/mesh_file_content.h"

namespace soft_tissue::studies
{
namespace
{
// No number that is none, no step that ends the process; back to the rest shape where physics says
// so.
TEST(Catalogue, OfHardCasesIsSurvived)
{
  const test::ScratchFolder folder;
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  const std::vector<HardCase> cases =
      hardCases(folder.path(""), data != nullptr ? std::string(data) + "/hard" : std::string());
  EXPECT_GE(cases.size(), data != nullptr ? 60u : 54u);
  std::printf("  %-46s %6s %9s %8s %8s %8s %4s %6s\n", "", "tets", "det F", "strain", "m/s",
              "energy", "held", "Newton");
  for (const HardCase& one : cases)
  {
    const HardResult r = runHardCase(one);
    std::printf("  %-46s %6zu %9.3g %8.1e %8.1e %8.2g %4d %6.1f\n", one.name.c_str(), r.tets,
                r.last_det_f, r.strain_left, r.rate_left, r.energy_growth, r.held, r.newton);
    EXPECT_TRUE(r.finite) << one.name;
    if (!one.may_hold)
    {
      EXPECT_EQ(r.held, 0) << one.name;
    }
    EXPECT_TRUE(r.endedAs(one.ending)) << one.name;
    if (!one.before && one.ending != Ending::anything && one.config.tissues[0].keyframes.empty())
    {
      EXPECT_LE(r.energy_growth, 1.0) << one.name;
    }
  }
}
}  // namespace
}  // namespace soft_tissue::studies
