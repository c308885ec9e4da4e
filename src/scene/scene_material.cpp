#include <algorithm>

#include "bodies.h"
#include "scene_impl.h"
#include "schema_sections.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/energy/membrane_elasticity.h"
#include "soft_tissue_sim/scene/material_change.h"

namespace soft_tissue
{
namespace
{
void exchangeNumber(StateArchive& archive, double& value)
{
  archive.value(value);
}

void exchangeNumber(StateArchive& archive, std::optional<double>& value)
{
  bool there = value.has_value();
  double number = value.value_or(0.0);
  archive.value(there);
  archive.value(number);
  value = there ? std::make_optional(number) : std::nullopt;
}

/** Gives `to` a value that is there. @throws Error naming it if it is out of range */
template <typename Value>
void take(const std::optional<double>& value, const Range& range, const char* key,
          const std::string& where, Value& to)
{
  if (value && !range.holds(*value))
  {
    throw Error(where + ": " + key + " = " + shortest(*value) + ", must be " + range.text());
  }
  if (value)
  {
    to = *value;
  }
}

/** Of a material or of a region. */
template <typename Parameters>
void takeAll(const MaterialChange& change, const std::string& where, Parameters& to)
{
  take(change.young_modulus_pa, kYoungModulus, "young_modulus_pa", where, to.young_modulus_pa);
  take(change.poisson_ratio, kPoissonRatio, "poisson_ratio", where, to.poisson_ratio);
  take(change.density_kg_per_m3, kDensity, "density_kg_per_m3", where, to.density_kg_per_m3);
  take(change.stiffening, kStiffening, "stiffening", where, to.stiffening);
}

void checkModel(const std::string& where, MaterialModel model, double poisson_ratio,
                const MaterialChange& change)
{
  const double least = leastPoissonRatio(model);
  if (poisson_ratio < least)
  {
    throw Error(where + ": poisson_ratio = " + shortest(poisson_ratio) + ", must be at least " +
                shortest(least) + " with model " + materialModel().show(model));
  }
  if (change.stiffening && model != MaterialModel::exponential)
  {
    throw Error(where + ": stiffening = " + shortest(*change.stiffening) +
                ", is for model exponential, which this is not of");
  }
}

/** A tissue's own materials and those of its regions, changed. */
void changeTissue(const MaterialChange& change, const std::string& where, TissueConfig& tissue)
{
  const MaterialConfig& material = tissue.material;
  if (!change.region)
  {
    takeAll(change, where, tissue.material);
    checkModel(where, material.model, material.poisson_ratio, change);
  }
  bool found = !change.region;
  for (RegionConfig& region : tissue.regions)
  {
    if (change.region && region.tag == *change.region)
    {
      takeAll(change, where, region);
      found = true;
    }
    const MaterialModel model = region.model.value_or(material.model);
    const bool changed = change.region && region.tag == *change.region;
    checkModel(where, model, region.poisson_ratio.value_or(material.poisson_ratio),
               changed ? change : MaterialChange());
  }
  if (!found)
  {
    std::string tags;
    for (const RegionConfig& region : tissue.regions)
    {
      tags += (tags.empty() ? "" : ", ") + std::to_string(region.tag);
    }
    throw Error(where + ": region = " + std::to_string(*change.region) + ", must be " +
                (tags.empty() ? "none: the scene file names no regions of it"
                              : "one that the scene file names: " + tags));
  }
}
}  // namespace

void Scene::Impl::setMaterial(std::size_t index, const MaterialChange& change)
{
  const std::string where = itemOf(index) + " '" + tissue_info_.at(index).name + "'";
  if (index < config_.tissues.size())
  {
    TissueConfig tissue = config_.tissues[index];
    changeTissue(change, where, tissue);
    std::swap(config_.tissues[index], tissue);
    try
    {
      takeMaterial(index);
    }
    catch (const Error&)
    {
      std::swap(config_.tissues[index], tissue);
      throw;
    }
    return;
  }
  MembraneConfig& membrane = config_.membranes[index - config_.tissues.size()];
  MaterialConfig material = membrane.material;
  if (change.region || change.stiffening)
  {
    throw Error(where + ": is a membrane, has no regions and no stiffening");
  }
  takeAll(change, where, material);
  membrane.material = material;
  takeMaterial(index);
}

/** Makes a body's terms and masses anew from its configuration. @throws Error if its mesh can't be
 * read any more, or is another; then nothing has changed */
void Scene::Impl::takeMaterial(std::size_t index)
{
  Tissue& tissue = tissues_[index];
  const TissueInfo& info = tissue_info_[index];
  const Index first = tissue.first_node, end = first + tissue.node_count;
  const auto clearMasses = [&] {
    std::fill(masses_.begin() + first, masses_.begin() + end, 0.0);
    std::fill(load_masses_.begin() + first, load_masses_.begin() + end, 0.0);
  };
  const MaterialConfig& material = config_.softBody(index).material;
  if (tissue.tets != nullptr)
  {
    const TissueModel model = makeTissue(config_.tissues[index], itemOf(index));
    if (model.info.rest.nodes != info.rest.nodes || model.info.rest.tets != info.rest.tets)
    {
      throw Error(itemOf(index) + ".mesh.file = " + config_.tissues[index].mesh.file +
                  " is not the mesh that the scene was made with");
    }
    auto tets = std::make_unique<TissueElasticity>(
        model, ViscosityParameters{material.stiffness_damping_s, material.relaxation}, first);
    tets->remember(*tissue.tets);
    tissue.tets = std::move(tets);
    clearMasses();
    addMasses(model, first, masses_, load_masses_);
  }
  else
  {
    const double thickness = config_.membranes[index - config_.tissues.size()].thickness_m;
    const TriMesh rest = {info.rest.nodes, info.surface.triangles};
    const std::size_t count = rest.triangles.size();
    tissue.membrane = std::make_unique<MembraneElasticity>(
        rest,
        std::vector<MembraneParameters>(
            count, {material.young_modulus_pa, material.poisson_ratio, thickness}),
        first);
    clearMasses();
    const std::vector<double> densities(count, material.density_kg_per_m3 * thickness);
    addLumpedMasses(rest, densities, first, masses_);
    addLumpedMasses(rest, densities, first, load_masses_);
  }
  for (Index i = first; !drags_.empty() && i < end; ++i)
  {
    drags_[i] = material.mass_damping_per_s * masses_[i];
  }
  for (const Contact& contact : contacts_)
  {
    contact.term->setBaseStiffness(stiffnessOf(config_.contacts[contact.named], contact));
  }
  if (asleep_[index] != 0)
  {
    wake(island_[index]);
    setSleepers();
  }
  forgetPast();
  newton_->forgetMatrix();
}

/** What may have been set at run time. */
void Scene::Impl::exchangeMaterials(StateArchive& archive)
{
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const SceneConfig before = config_;
    const bool is_tissue = k < config_.tissues.size();
    MaterialConfig& material = is_tissue ? config_.tissues[k].material
                                         : config_.membranes[k - config_.tissues.size()].material;
    const auto number = [&](auto& value) {
      const auto before = value;
      exchangeNumber(archive, value);
      return value != before;
    };
    bool changed = number(material.young_modulus_pa);
    changed |= number(material.poisson_ratio);
    changed |= number(material.density_kg_per_m3);
    changed |= number(material.stiffening);
    for (std::size_t r = 0; is_tissue && r < config_.tissues[k].regions.size(); ++r)
    {
      RegionConfig& region = config_.tissues[k].regions[r];
      changed |= number(region.young_modulus_pa);
      changed |= number(region.poisson_ratio);
      changed |= number(region.density_kg_per_m3);
      changed |= number(region.stiffening);
    }
    try
    {
      if (changed)
      {
        takeMaterial(k);
      }
    }
    catch (const Error&)
    {
      config_ = before;
      throw;
    }
  }
}

void Scene::setMaterial(std::size_t tissue, const MaterialChange& change)
{
  impl_->setMaterial(tissue, change);
}

}  // namespace soft_tissue
