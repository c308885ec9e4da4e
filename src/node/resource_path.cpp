#include "soft_tissue_sim/node/resource_path.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/package_resolver.h"

namespace fs = std::filesystem;

namespace soft_tissue_sim
{
namespace
{
bool startsWith(const std::string& text, const std::string& prefix)
{
  return text.compare(0, prefix.size(), prefix) == 0;
}

std::string lowerCase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

fs::path localPath(const std::string& uri, const std::string& folder)
{
  const std::string package_scheme = "package://";
  const std::string file_scheme = "file://";
  if (startsWith(uri, package_scheme))
  {
    const std::string rest = uri.substr(package_scheme.size());
    const std::size_t slash = rest.find('/');
    if (slash == 0 || slash == std::string::npos)
    {
      throw soft_tissue::Error("'" + uri + "' is not of the form package://PACKAGE/PATH");
    }
    const std::string package = rest.substr(0, slash);
    const std::string package_folder = findPackage(package);
    if (package_folder.empty())
    {
      throw soft_tissue::Error("'" + uri + "': rospack knows no package '" + package + "'");
    }
    return fs::path(package_folder) / rest.substr(slash + 1);
  }
  if (startsWith(uri, file_scheme))
  {
    return uri.substr(file_scheme.size());
  }
  if (uri.find("://") != std::string::npos)
  {
    throw soft_tissue::Error("'" + uri + "' must be package://, file:// or a path");
  }
  return fs::path(folder) / uri;  // an absolute uri replaces the folder
}

/** What is wrong with a path that does not exist: its first missing part and a name nearly alike.
 */
std::string explainMissing(const fs::path& path)
{
  fs::path existing;
  for (const fs::path& part : path)
  {
    if (fs::exists(existing / part))
    {
      existing /= part;
      continue;
    }
    std::string text = "there is no '" + part.string() + "' in " + existing.string();
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(existing, ignored))
    {
      const std::string name = entry.path().filename().string();
      if (lowerCase(name) == lowerCase(part.string()))
      {
        text += "; the name differs in upper and lower case from '" + name + "'";
      }
    }
    return text;
  }
  return "it is not a regular file";
}

}  // namespace

std::string resolveResource(const std::string& uri, const std::string& folder)
{
  const fs::path path = localPath(uri, folder).lexically_normal();
  if (!fs::is_regular_file(path))
  {
    throw soft_tissue::Error("file '" + path.string() + "' is missing: " + explainMissing(path));
  }
  return path.string();
}

}  // namespace soft_tissue_sim
