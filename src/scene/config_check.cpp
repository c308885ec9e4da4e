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

/** Tissues and tools share one name space, for their names become ROS namespaces. */
void checkNames(const Item& scene)
{
  std::vector<Item> names;
  for (const char* list : {"tissues", "tools"})
  {
    const std::size_t size = scene.has(list) ? scene.at(list).size() : 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      names.push_back(scene.at(list).at(i).at("name"));
    }
  }
  for (auto name = names.begin(); name != names.end(); ++name)
  {
    const auto first = std::find_if(
        names.begin(), name, [&](const Item& other) { return other.scalar() == name->scalar(); });
    if (first != name)
    {
      name->rejectValue("is " + first->path() + " too, must be new");
    }
  }
}

/** Puts a pair in the order tissue, tool. */
void orderPair(const Item& between, const SceneConfig& scene, ContactConfig& contact)
{
  for (const std::string& name : {contact.tissue, contact.tool})
  {
    if (!hasName(scene.tissues, name) && !hasName(scene.tools, name))
    {
      between.rejectValue("there is no tissue or tool '" + name + "'");
    }
  }
  if (hasName(scene.tools, contact.tissue))
  {
    std::swap(contact.tissue, contact.tool);
  }
  if (hasName(scene.tools, contact.tissue))
  {
    between.rejectValue("must be a tissue and a tool; tools don't touch each other");
  }
  if (hasName(scene.tissues, contact.tool))
  {
    between.rejectValue("contact between tissues is " + std::string(kNotAvailable));
  }
}

}  // namespace

void checkScene(const Item& item, SceneConfig& scene)
{
  if (item.has("materials"))
  {
    loadPresets(item.at("materials"), item.at("materials").scalar());
  }
  checkNames(item);
  for (std::size_t i = 0; i < scene.contacts.size(); ++i)
  {
    ContactConfig& contact = scene.contacts[i];
    const Item between = item.at("contacts").at(i).at("between");
    orderPair(between, scene, contact);
    for (std::size_t j = 0; j < i; ++j)
    {
      if (scene.contacts[j].tissue == contact.tissue && scene.contacts[j].tool == contact.tool)
      {
        between.rejectValue("is the pair of contacts[" + std::to_string(j) + "] too, must be new");
      }
    }
  }
}

}  // namespace soft_tissue
