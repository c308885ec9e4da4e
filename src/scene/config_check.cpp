#include <algorithm>

#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
template <class Bodies>
bool hasName(const Bodies& bodies, const std::string& name)
{
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](const auto& body) { return body.name == name; });
}

/** Of markers of contacts between tissues; topics need no such word, for none of a tissue or tool
 * is its bare name. */
const char* const kMarkersOfPairs = "tissue_pairs";

/** Soft bodies, tools and obstacles share one name space, for their names become namespaces of
 * topics and markers. */
void checkNames(const Item& scene)
{
  std::vector<Item> names;
  for (const char* list : {"tissues", "membranes", "tools", "obstacles"})
  {
    const std::size_t size = scene.has(list) ? scene.at(list).size() : 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      names.push_back(scene.at(list).at(i).at("name"));
    }
  }
  for (auto name = names.begin(); name != names.end(); ++name)
  {
    if (name->scalar() == kMarkersOfPairs)
    {
      name->rejectValue("is what markers of contacts are called, must be another name");
    }
    const auto first = std::find_if(
        names.begin(), name, [&](const Item& other) { return other.scalar() == name->scalar(); });
    if (first != name)
    {
      name->rejectValue("is " + first->path() + " too, must be new");
    }
  }
}

bool isRigid(const SceneConfig& scene, const std::string& name)
{
  return hasName(scene.tools, name) || hasName(scene.obstacles, name);
}

/** Puts a soft body before a tool or obstacle, and a membrane before a tissue. */
void orderPair(const Item& between, const SceneConfig& scene, ContactConfig& contact)
{
  for (const std::string& name : {contact.tissue, contact.other})
  {
    if (!hasName(scene.tissues, name) && !hasName(scene.membranes, name) && !isRigid(scene, name))
    {
      between.rejectValue("there is no tissue, membrane, tool or obstacle '" + name + "'");
    }
  }
  if (isRigid(scene, contact.tissue) || hasName(scene.membranes, contact.other))
  {
    std::swap(contact.tissue, contact.other);
  }
  if (isRigid(scene, contact.tissue))
  {
    between.rejectValue(
        "must have a tissue or a membrane; tools and obstacles don't touch each other");
  }
  if (hasName(scene.membranes, contact.other))
  {
    between.rejectValue("must have a tissue, tool or obstacle; membranes don't touch each other");
  }
}

/** Damping by mass is of velocities, which are zero without inertia. */
template <class Bodies>
void checkDrag(const Item& item, const Bodies& bodies, const char* list, Stepper stepper)
{
  for (std::size_t k = 0; k < bodies.size() && stepper == Stepper::quasi_static; ++k)
  {
    if (bodies[k].material.mass_damping_per_s > 0.0)
    {
      item.at(list)
          .at(k)
          .at("material")
          .reject("has mass_damping_per_s, which needs stepper implicit_euler");
    }
  }
}

bool samePair(const ContactConfig& a, const ContactConfig& b)
{
  return (a.tissue == b.tissue && a.other == b.other) ||
         (a.tissue == b.other && a.other == b.tissue);
}

}  // namespace

void checkScene(const Item& item, SceneConfig& scene)
{
  if (item.has("materials"))
  {
    loadPresets(item.at("materials"), item.at("materials").scalar());
  }
  if (scene.tissues.empty() && scene.membranes.empty())
  {
    item.rejectKey("tissues", "missing, must have a tissue, or membranes a membrane");
  }
  checkNames(item);
  checkDrag(item, scene.tissues, "tissues", scene.solver.stepper);
  checkDrag(item, scene.membranes, "membranes", scene.solver.stepper);
  for (std::size_t i = 0; i < scene.contacts.size(); ++i)
  {
    ContactConfig& contact = scene.contacts[i];
    const Item between = item.at("contacts").at(i).at("between");
    orderPair(between, scene, contact);
    for (std::size_t j = 0; j < i; ++j)
    {
      if (samePair(scene.contacts[j], contact))
      {
        between.rejectValue("is the pair of contacts[" + std::to_string(j) + "] too, must be new");
      }
    }
  }
}

}  // namespace soft_tissue
