#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/base/hash.h"
#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/energy/viscosity.h"

namespace soft_tissue
{
struct TissueModel;

/** Elasticity of a tissue: a term for each of the models its elements have, and its viscosity. */
class TissueElasticity
{
 public:
  /** @param first_node  row of the tissue's node 0 among all positions */
  TissueElasticity(const TissueModel& model, const ViscosityParameters& viscosity,
                   Index first_node);

  /** A step of this length begins, or begins anew, with nodes at x. */
  void beginStep(const Points& x, double step);
  /** It has ended. */
  void endStep(const Points& x);
  /** Back to the rest state that nothing has happened to. */
  void forget();
  /** Keeps what it remembers, to go back to it. */
  void save();
  void restore();
  void addTo(StateHash& hash) const;
  /** Takes over what another one of the same body remembers. */
  void remember(const TissueElasticity& other);
  /** Writes, or reads, what it remembers. */
  void exchange(StateArchive& archive);

  void addTerms(std::vector<EnergyTerm*>& terms) const;

  /** Smallest det F of all elements. */
  double minDetF(const Points& x) const;

  /** Equivalent (von Mises) stress per tet of TissueInfo::rest, Pa. */
  void vonMises(const Points& x, std::vector<float>& stress);

 private:
  /** The elements of one model. */
  struct Part
  {
    std::unique_ptr<EnergyTerm> energy;
    DeformationMeasures* measures = nullptr;  ///< the energy, as what it is too
    std::unique_ptr<Viscosity> viscosity;     ///< null: none
    std::vector<double> saved;                ///< its memory
    std::vector<Index> elements;              ///< their numbers in the tissue, ascending
    std::vector<float> stress;
  };
  /** @return the energy */
  template <typename Energy>
  Energy& addPart(std::unique_ptr<Energy> energy, std::vector<Index> elements);
  template <typename Visit>
  void forViscous(const Visit& visit);

  std::vector<Part> parts_;
};

}  // namespace soft_tissue
