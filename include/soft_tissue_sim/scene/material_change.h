#pragma once

#include <optional>

namespace soft_tissue
{
/** What a tissue's or membrane's material has anew; what is empty stays as it is. Ranges are those
 * of a scene file. */
struct MaterialChange
{
  /** Tag of a region: of that alone. Else of the tissue, but for what its regions have of their
   * own. */
  std::optional<int> region = {};
  std::optional<double> young_modulus_pa = {};
  std::optional<double> poisson_ratio = {};
  std::optional<double> density_kg_per_m3 = {};
  std::optional<double> stiffening = {};  ///< of the exponential model alone
};

}  // namespace soft_tissue
