#include <algorithm>
#include <array>

#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
/** The unit a key's ending names, as it is written in tables. */
std::string unitOf(const std::string& key)
{
  constexpr std::array<std::array<const char*, 2>, 11> units = {{{"_pa_per_m", "Pa/m"},
                                                                 {"_m_per_s2", "m/s²"},
                                                                 {"_m_per_s", "m/s"},
                                                                 {"_kg_per_m3", "kg/m³"},
                                                                 {"_rad_per_s", "rad/s"},
                                                                 {"_per_s", "1/s"},
                                                                 {"_pa", "Pa"},
                                                                 {"_rad", "rad"},
                                                                 {"_s", "s"},
                                                                 {"_rad_or_m", "rad or m"},
                                                                 {"_m", "m"}}};
  for (const auto& unit : units)
  {
    const std::string ending = unit[0];
    if (key.size() > ending.size() &&
        key.compare(key.size() - ending.size(), ending.size(), ending) == 0)
    {
      return unit[1];
    }
  }
  return "";
}

std::string anchor(std::string title)
{
  std::replace(title.begin(), title.end(), ' ', '-');
  return title;
}

std::string defaultOf(const KeyInfo& info)
{
  switch (info.need)
  {
    case KeyInfo::Need::required:
      return "**required**";
    case KeyInfo::Need::alternative:
      return "**one of these**";
    default:
      return info.default_text;
  }
}

std::string row(const KeyInfo& info)
{
  std::string type = info.type;
  if (info.section != nullptr)
  {
    type += ": [" + info.section->title() + "](#" + anchor(info.section->title()) + ")";
  }
  std::string line = "| `" + info.key + "` ";
  for (const std::string& cell :
       {type, unitOf(info.key), info.allowed, defaultOf(info), info.description})
  {
    line += "| " + cell + (cell.empty() ? "" : " ");
  }
  return line + "|\n";
}

void describe(const SectionBase& section, std::vector<const SectionBase*>& told, std::string& out)
{
  if (std::find(told.begin(), told.end(), &section) != told.end())
  {
    return;
  }
  told.push_back(&section);
  out += "\n## " + section.title() + "\n\n" + section.description() + "\n\n";
  out += "| Key | Type | Unit | Allowed | Default | Meaning |\n|---|---|---|---|---|---|\n";
  std::string later;
  for (const KeyInfo& info : section.keys())
  {
    if (info.need == KeyInfo::Need::not_available)
    {
      later += "- `" + info.key + "`: " + info.description + "\n";
    }
    else
    {
      out += row(info);
    }
  }
  if (!later.empty())
  {
    out += "\nKnown, but " + std::string(kNotAvailable) + ":\n\n" + later;
  }
  for (const KeyInfo& info : section.keys())
  {
    if (info.section != nullptr)
    {
      describe(*info.section, told, out);
    }
  }
}

}  // namespace

std::string describeSchema()
{
  std::string out =
      "# The scene file\n\n"
      "Generated from the schema the parser checks files with; do not edit by hand.\n\n"
      "A scene is one YAML file. Everything in it is in SI units, and keys end in their unit. "
      "Unknown keys, keys that stand twice and values out of range are errors that name the file, "
      "the key, the value and what is allowed.\n\n"
      "File names are paths relative to the scene file's folder, absolute paths, "
      "`package://PACKAGE/FILE` or `file:///PATH`.\n\n"
      "Scenes to start from are in `config/scenes`.\n";
  std::vector<const SectionBase*> told;
  describe(sceneSection(), told, out);
  describe(presetsSection(), told, out);
  return out;
}

}  // namespace soft_tissue
