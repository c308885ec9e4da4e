#include "tissue_elasticity.h"

#include <algorithm>

#include "bodies.h"
#include "soft_tissue_sim/energy/mass_spring.h"
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

TetMesh ofElements(const TetMesh& all, const std::vector<Index>& elements)
{
  return {all.nodes, ofElements(all.tets, elements), ofElements(all.tags, elements)};
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
  const TetMesh mesh = ofElements(model.info.rest, elements);
  if (model.element == ElementKind::tet4_anp)
  {
    return std::make_unique<NodalPressureElasticity>(mesh, law, stiffness, first_node);
  }
  return std::make_unique<TetElasticity>(mesh, law, stiffness, first_node);
}

std::vector<Index> elementsOf(const TissueModel& model, MaterialModel law)
{
  std::vector<Index> elements;
  for (std::size_t k = 0; k < model.laws.size(); ++k)
  {
    if (model.laws[k] == law)
    {
      elements.push_back(static_cast<Index>(k));
    }
  }
  return elements;
}
}  // namespace

TissueElasticity::TissueElasticity(const TissueModel& model, const ViscosityParameters& viscosity,
                                   Index first_node)
{
  for (const MaterialModel law : kMaterialModels)
  {
    const std::vector<Index> elements = elementsOf(model, law);
    if (!elements.empty())
    {
      Elasticity& energy = addPart(elasticityOf(model, law, elements, first_node), elements);
      if (!viscosity.none())
      {
        parts_.back().viscosity =
            std::make_unique<Viscosity>(energy, ofElements(model.stiffness, elements), viscosity);
      }
    }
  }
  const std::vector<Index> elements = elementsOf(model, MaterialModel::mass_spring);
  if (!elements.empty())
  {
    addPart(std::make_unique<MassSpring>(ofElements(model.info.rest, elements),
                                         ofElements(model.stiffness, elements), first_node),
            elements);
  }
}

template <typename Energy>
Energy& TissueElasticity::addPart(std::unique_ptr<Energy> energy, std::vector<Index> elements)
{
  Energy& added = *energy;
  parts_.emplace_back();
  parts_.back().energy = std::move(energy);
  parts_.back().measures = &added;
  parts_.back().elements = std::move(elements);
  return added;
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
  double smallest = parts_[0].measures->minDetF(x);
  for (std::size_t k = 1; k < parts_.size(); ++k)
  {
    smallest = std::min(smallest, parts_[k].measures->minDetF(x));
  }
  return smallest;
}

void TissueElasticity::vonMises(const Points& x, std::vector<float>& stress)
{
  if (parts_.size() == 1)
  {
    parts_[0].measures->vonMises(x, stress);
    return;
  }
  for (Part& part : parts_)
  {
    part.measures->vonMises(x, part.stress);
    const std::size_t each = part.stress.size() / part.elements.size();
    stress.resize(std::max(stress.size(), each * (part.elements.back() + 1)));
    for (std::size_t k = 0; k < part.elements.size(); ++k)
    {
      std::copy_n(part.stress.begin() + each * k, each, stress.begin() + each * part.elements[k]);
    }
  }
}

}  // namespace soft_tissue
