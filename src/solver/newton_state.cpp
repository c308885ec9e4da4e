#include <algorithm>
#include <cstdint>

#include "soft_tissue_sim/solver/newton.h"

namespace soft_tissue
{
void NewtonSolver::exchange(StateArchive& archive, const std::vector<EnergyTerm*>& terms)
{
  archive.value(reach_);
  archive.value(matrix_serves_);
  archive.value(matrix_leads_);
  archive.value(trust_);
  archive.value(trusted_);
  linear_->exchange(archive);
  if (!matrix_serves_ && !matrix_leads_)
  {
    return;
  }
  std::vector<std::uint64_t> places;
  for (const EnergyTerm* term : archive.reading() ? std::vector<EnergyTerm*>() : matrix_terms_)
  {
    places.push_back(std::find(terms.begin(), terms.end(), term) - terms.begin());
  }
  archive.list(places);
  std::vector<Coupling> couplings = hessian_.couplings();
  std::uint64_t count = couplings.size();
  archive.value(count);
  couplings.resize(archive.reading() ? count : couplings.size());
  for (Coupling& coupling : couplings)
  {
    archive.value(coupling.row);
    archive.value(coupling.column);
    archive.value(coupling.block);
  }
  if (archive.reading())
  {
    matrix_terms_.clear();
    for (const std::uint64_t place : places)
    {
      matrix_terms_.push_back(terms.at(place));
    }
    hessian_.setZero();
    for (const Coupling& coupling : couplings)
    {
      hessian_.add(coupling.row, coupling.column, coupling.block);
    }
  }
  archive.values(hessian_.values());
  hessian_.outer().exchange(archive);
  archive.list(matrix_at_);
  if (archive.reading())
  {
    linear_->setMatrix(hessian_, matrix_at_);
  }
}

}  // namespace soft_tissue
