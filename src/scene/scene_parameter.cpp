#include "soft_tissue_sim/scene/scene_parameter.h"

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr const char* kKeys =
    "young_modulus_pa, poisson_ratio or stiffening of TISSUE or TISSUE/REGION, stiffness_pa_per_m "
    "or friction of TISSUE/OTHER";
/** Where Poisson's ratio and friction are looked for: nearer to a half nothing would tell. */
constexpr double kMostPoisson = 0.4995, kMostFriction = 2.0;

double* numberOf(std::optional<double>& number)
{
  return number ? &*number : nullptr;
}

double* materialNumber(MaterialConfig& material, const std::string& key)
{
  return key == "young_modulus_pa" ? &material.young_modulus_pa
         : key == "poisson_ratio"  ? &material.poisson_ratio
         : key == "stiffening"     ? numberOf(material.stiffening)
                                   : nullptr;
}

double* regionNumber(RegionConfig& region, const std::string& key)
{
  return key == "young_modulus_pa" ? numberOf(region.young_modulus_pa)
         : key == "poisson_ratio"  ? numberOf(region.poisson_ratio)
         : key == "stiffening"     ? numberOf(region.stiffening)
                                   : nullptr;
}

double* contactNumber(ContactConfig& contact, const std::string& key)
{
  return key == "stiffness_pa_per_m" ? numberOf(contact.stiffness_pa_per_m)
         : key == "friction"         ? &contact.friction
                                     : nullptr;
}
}  // namespace

SceneParameter::SceneParameter(const SceneConfig& scene, const std::string& name) : name_(name)
{
  const std::size_t first = name.find('/'), last = name.rfind('/');
  if (first == std::string::npos)
  {
    throw Error("parameter " + name + ": must be " + kKeys);
  }
  body_ = name.substr(0, first);
  part_ = first == last ? "" : name.substr(first + 1, last - first - 1);
  key_ = name.substr(last + 1);
  if (key_ == "poisson_ratio" || key_ == "friction")
  {
    upper_ = key_ == "friction" ? kMostFriction : kMostPoisson;
  }
  SceneConfig copy = scene;
  const double* number = find(copy);
  if (number == nullptr)
  {
    throw Error("parameter " + name + ": scene " + scene.file +
                " says no such number, which must be " + kKeys);
  }
  if (isLogarithmic() && !(*number > 0.0))
  {
    throw Error("parameter " + name + " = " + std::to_string(*number) +
                ": must be above 0 to start from");
  }
}

double SceneParameter::value(const SceneConfig& scene) const
{
  SceneConfig copy = scene;
  return *find(copy);
}

void SceneParameter::set(SceneConfig& scene, double value) const
{
  *find(scene) = value;
}

/** Null if the scene has no such number. */
double* SceneParameter::find(SceneConfig& scene) const
{
  for (ContactConfig& contact : scene.contacts)
  {
    if (contact.tissue == body_ && contact.other == part_)
    {
      if (double* number = contactNumber(contact, key_))
      {
        return number;
      }
    }
  }
  for (TissueConfig& tissue : scene.tissues)
  {
    for (RegionConfig& region : tissue.regions)
    {
      if (tissue.name == body_ && std::to_string(region.tag) == part_)
      {
        return regionNumber(region, key_);
      }
    }
    if (tissue.name == body_ && part_.empty())
    {
      return materialNumber(tissue.material, key_);
    }
  }
  for (MembraneConfig& membrane : scene.membranes)
  {
    if (membrane.name == body_ && part_.empty())
    {
      return materialNumber(membrane.material, key_);
    }
  }
  return nullptr;
}

}  // namespace soft_tissue
