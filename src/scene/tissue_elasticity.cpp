#include "tissue_elasticity.h"

#include <algorithm>

#include "bodies.h"
#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"

namespace soft_tissue
{
namespace
{
/** What of `all` these elements have. */
template <typename T>
std::vector<T> ofElements(const std::vector<T>& all, const std::vector<Index>& elements)
{
  std::vector<T> some;
  some.reserve(elements.size());
  for (const Index element : elements)
  {
    some.push_back(all[element]);
  }
  return some;
}

std::unique_ptr<Elasticity> elasticityOf(const TissueModel& model, MaterialModel law,
                                         const std::vector<Index>& elements, Index first_node)
{
  const std::vector<TetStiffnessParameters> stiffness = ofElements(model.stiffness, elements);
  if (model.quadratic)
  {
    const QuadraticTetMesh& all = *model.quadratic;
    const QuadraticTetMesh mesh = {all.nodes, ofElements(all.elements, elements),
                                   ofElements(all.tags, elements)};
    return std::make_unique<QuadraticTetElasticity>(mesh, law, stiffness, first_node);
  }
  const TetMesh& all = model.info.rest;
  const TetMesh mesh = {all.nodes, ofElements(all.tets, elements), ofElements(all.tags, elements)};
  if (model.element == ElementKind::tet4_anp)
  {
    return std::make_unique<NodalPressureElasticity>(mesh, law, stiffness, first_node);
  }
  return std::make_unique<TetElasticity>(mesh, law, stiffness, first_node);
}
}  // namespace

TissueElasticity::TissueElasticity(const TissueModel& model, const ViscosityParameters& viscosity,
                                   Index first_node)
{
  for (const MaterialModel law : kMaterialModels)
  {
    Part part;
    for (std::size_t k = 0; k < model.laws.size(); ++k)
    {
      if (model.laws[k] == law)
      {
        part.elements.push_back(static_cast<Index>(k));
      }
    }
    if (!part.elements.empty())
    {
      part.energy = elasticityOf(model, law, part.elements, first_node);
      if (!viscosity.none())
      {
        part.viscosity = std::make_unique<Viscosity>(
            *part.energy, ofElements(model.stiffness, part.elements), viscosity);
      }
      parts_.push_back(std::move(part));
    }
  }
}

void TissueElasticity::addTerms(std::vector<EnergyTerm*>& terms) const
{
  for (const Part& part : parts_)
  {
    terms.push_back(part.energy.get());
    if (part.viscosity != nullptr)
    {
      terms.push_back(part.viscosity.get());
    }
  }
}

template <typename Visit>
void TissueElasticity::forViscous(const Visit& visit)
{
  for (Part& part : parts_)
  {
    if (part.viscosity != nullptr)
    {
      visit(part);
    }
  }
}

void TissueElasticity::beginStep(const Points& x, double step)
{
  forViscous([&](Part& part) { part.viscosity->beginStep(x, step); });
}

void TissueElasticity::endStep(const Points& x)
{
  forViscous([&](Part& part) { part.viscosity->endStep(x); });
}

void TissueElasticity::forget()
{
  forViscous([](Part& part) { part.viscosity->forget(); });
}

void TissueElasticity::save()
{
  forViscous([](Part& part) { part.saved = part.viscosity->memory(); });
}

void TissueElasticity::restore()
{
  forViscous([](Part& part) { part.viscosity->setMemory(part.saved); });
}

void TissueElasticity::remember(const TissueElasticity& other)
{
  for (std::size_t k = 0; k < parts_.size(); ++k)
  {
    if (parts_[k].viscosity != nullptr)
    {
      parts_[k].viscosity->setMemory(other.parts_[k].viscosity->memory());
    }
  }
}

void TissueElasticity::exchange(StateArchive& archive)
{
  forViscous([&](Part& part) {
    std::vector<double> memory = part.viscosity->memory();
    archive.values(memory);
    part.viscosity->setMemory(memory);
  });
}

void TissueElasticity::addTo(StateHash& hash) const
{
  for (const Part& part : parts_)
  {
    if (part.viscosity != nullptr)
    {
      const std::vector<double>& memory = part.viscosity->memory();
      hash.add(memory.data(), memory.size() * sizeof(double));
    }
  }
}

double TissueElasticity::minDetF(const Points& x) const
{
  double smallest = parts_[0].energy->minDetF(x);
  for (std::size_t k = 1; k < parts_.size(); ++k)
  {
    smallest = std::min(smallest, parts_[k].energy->minDetF(x));
  }
  return smallest;
}

void TissueElasticity::vonMises(const Points& x, std::vector<float>& stress)
{
  if (parts_.size() == 1)
  {
    parts_[0].energy->vonMises(x, stress);
    return;
  }
  for (Part& part : parts_)
  {
    part.energy->vonMises(x, part.stress);
    const std::size_t each = part.stress.size() / part.elements.size();
    stress.resize(std::max(stress.size(), each * (part.elements.back() + 1)));
    for (std::size_t k = 0; k < part.elements.size(); ++k)
    {
      std::copy_n(part.stress.begin() + each * k, each, stress.begin() + each * part.elements[k]);
    }
  }
}

}  // namespace soft_tissue
