#pragma once

#include <vector>

namespace soft_tissue
{
/** What holds tets together. Constitutive laws are one struct each in src/energy and one line in
 * materials.h there; each model is one word of the scene file. */
enum class MaterialModel
{
  neo_hookean,          ///< stable neo-Hookean. Source: [Smith2018] eq. 14
  neo_hookean_log,      ///< neo-Hookean of textbooks, with log J. Source: [Bonet2008] eq. 6.27
  exponential,          ///< stiffens with stretch. Source: [Demiray1972], made compressible
  corotated,            ///< linear in the polar stretch. Source: [Sifakis2012] section 3.4
  st_venant_kirchhoff,  ///< linear in Green's strain
  linear,               ///< of small strains: it takes rotations for strains
  mass_spring,          ///< no law of strain: springs along edges, see MassSpring
};

/** The constitutive laws: functions of the deformation gradient. */
constexpr MaterialModel kMaterialModels[] = {
    MaterialModel::neo_hookean, MaterialModel::neo_hookean_log,     MaterialModel::exponential,
    MaterialModel::corotated,   MaterialModel::st_venant_kirchhoff, MaterialModel::linear};

/** The least Poisson's ratio a model takes: below it log(det F)^2 would pull tets to nothing, and
 * springs alone have 1/4. */
constexpr double leastPoissonRatio(MaterialModel model)
{
  return model == MaterialModel::neo_hookean_log ? 0.0
         : model == MaterialModel::mass_spring   ? 0.25
                                                 : -1.0;
}

/** Below this det F the neo_hookean_log law goes on quadratically in det F. */
constexpr double kLeastLogVolume = 0.1;

/** Past this exponent, where shear is 1097 times as stiff as at rest, the exponential law goes on
 * quadratically. */
constexpr double kSteepestExponent = 7.0;

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

/** What the constants of a law are made from. */
struct LawParameters
{
  double mu = 0.0;          ///< Pa, at small strain
  double lambda = 0.0;      ///< Pa, at small strain
  double stiffening = 0.0;  ///< see TetStiffnessParameters
};

/** Stiffness of one tet. */
struct TetStiffnessParameters
{
  double young_modulus = 0.0;  ///< Pa, > 0, at small strain
  double poisson_ratio = 0.0;  ///< in (-1, 0.5), at small strain
  double stiffening = 1.0;     ///< > 0; how fast the exponential law does; no other law reads it
};

/** A stress that a strain brings and time takes away: one term of a Prony series. */
struct RelaxationBranch
{
  double relative_modulus = 0.0;  ///< > 0, in the stiffness that stays
  double relaxation_time = 0.0;   ///< s, > 0
};

/** What of a tissue resists to being deformed fast. */
struct ViscosityParameters
{
  double stiffness_damping = 0.0;            ///< s, >= 0: stress per rate over stress per strain
  std::vector<RelaxationBranch> relaxation;  ///< the Prony series

  bool none() const { return stiffness_damping == 0.0 && relaxation.empty(); }
};

}  // namespace soft_tissue
