#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/contact/sample_sums.h"
#include "support/contact_scene.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kStiffness = 2e6;  // Pa/m
constexpr double kPressed = 0.001;  // m
constexpr double kSide = 0.01;      // m, of the punch
constexpr double kTop = 0.02;       // m

/** Upward force on a punch in a slab of n x n x 2 cells, from the samples of one direction. */
double punchForce(const ContactOptions& options, int n, int side)
{
  const Vec3 low(-0.02, -0.02, 0.0);
  ContactScene scene(slab(low, {0.02, 0.02, kTop}, n, n, 2), makeBox({kSide, kSide, kSide}),
                     options);
  const Points& x = scene.mesh.nodes;
  scene.begin(x, at({0.0007, 0.0004, kTop - kPressed + 0.5 * kSide}));
  double force = 0.0;
  for (const ContactSample& s : scene.contact->samples(x))
  {
    force += s.side == side ? s.forceOnFirst().z() : 0.0;
  }
  return force;
}

void print(const ContactOptions& options, const char* what, int n, double force, double exact)
{
  std::printf("  %-27s %s, %2d x %2d x 2 cells: %.5f N, exact %.5f N (%+.2f %%)\n",
              nameOf(options).c_str(), what, n, n, force, exact, 100.0 * (force / exact - 1.0));
}
}  // namespace

// The bottom of the punch is at depth d, its walls from 0 to d; all are pushed up.
TEST(FlatPunch, IsPushedOutByStiffnessTimesDepthTimesArea)
{
  const double exact =
      0.5 * kStiffness * (kPressed * kSide * kSide + 4.0 * kSide * 0.5 * kPressed * kPressed);
  for (const ContactOptions& options : contactModels(kStiffness))
  {
    // The walls reach only a fraction of their triangles deep: points see them coarsely.
    const double tolerance = options.segments ? 0.05 : 0.15;
    const double force = punchForce(options, 16, 1);
    print(options, "punch in tissue", 16, force, exact);
    EXPECT_NEAR(force, exact, tolerance * exact) << nameOf(options);
  }
}

// Tissue in the punch is pushed down where the bottom is its nearest face.
TEST(FlatPunch, PushesTissueDownAndConvergesWithItsMesh)
{
  const double width = kSide - 2.0 * kPressed;
  for (const ContactOptions& options : contactModels(kStiffness))
  {
    const double exact = 0.5 * kStiffness * kPressed * width * width;
    const double coarse = punchForce(options, 12, -1);
    const double fine = punchForce(options, 48, -1);
    print(options, "tissue in punch", 12, coarse, exact);
    print(options, "tissue in punch", 48, fine, exact);
    EXPECT_NEAR(coarse, exact, 0.35 * exact) << nameOf(options);
    EXPECT_NEAR(fine, exact, 0.05 * exact) << nameOf(options);
  }
}

}  // namespace soft_tissue::test
