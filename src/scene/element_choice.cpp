#include "element_choice.h"

#include <algorithm>

#include "schema_kinds.h"

namespace soft_tissue
{
namespace
{
/** Meshes of no more tets are coarse: quadratic ones there take about as long a step as 20,000
 * linear ones, and are nearer. */
constexpr std::size_t kCoarse = 2000;
/** From this Poisson's ratio on linear tets lock enough for nodal pressures to be worth it. */
constexpr double kLocks = 0.4;

/** The largest of the material and its regions. */
double poissonRatioOf(const TissueConfig& tissue)
{
  double largest = tissue.material.poisson_ratio;
  for (const RegionConfig& region : tissue.regions)
  {
    largest = std::max(largest, region.poisson_ratio.value_or(largest));
  }
  return largest;
}
}  // namespace

ElementKind elementOf(const TissueConfig& tissue, std::size_t tets)
{
  if (tissue.element != ElementKind::automatic)
  {
    return tissue.element;
  }
  if (tets <= kCoarse)
  {
    return ElementKind::tet10;
  }
  return poissonRatioOf(tissue) >= kLocks ? ElementKind::tet4_anp : ElementKind::tet4;
}

std::string describeElementChoice()
{
  return "tet10 for meshes of up to " + std::to_string(kCoarse) +
         " tets; for finer ones tet4_anp where a Poisson's ratio is " + shortest(kLocks) +
         " or more, else tet4";
}

}  // namespace soft_tissue
