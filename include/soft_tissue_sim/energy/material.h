#pragma once

namespace soft_tissue
{
/** Constitutive laws. Each is one struct in src/energy/materials.h and one line in
 * tet_kernels_impl.h. */
enum class MaterialModel
{
  neo_hookean,  ///< stable neo-Hookean. Source: [Smith2018] eq. 14
  corotated,    ///< linear in the polar stretch. Source: [Sifakis2012] section 3.4
};

/** Lamé parameters, Pa. */
struct Lame
{
  double mu = 0.0;
  double lambda = 0.0;
};

/** From Young's modulus (Pa, > 0) and Poisson's ratio in (-1, 0.5). */
inline Lame lameFrom(double young_modulus, double poisson_ratio)
{
  return {young_modulus / (2.0 * (1.0 + poisson_ratio)),
          young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio))};
}

}  // namespace soft_tissue
