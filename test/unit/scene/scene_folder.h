#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** A folder of its own for the files of one test, gone when the test is. */
class SceneFolder
{
 public:
  SceneFolder()
  {
    std::string pattern = (std::filesystem::temp_directory_path() / "scene_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
    write("mesh.msh", "a stand-in: the scene file only names it\n");
    std::filesystem::create_directory(path_ + "/folder");
  }
  ~SceneFolder() { std::filesystem::remove_all(path_); }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  const std::string& path() const { return path_; }

  std::string write(const std::string& name, const std::string& text) const
  {
    const std::string file = path_ + "/" + name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::string path_;
};

/** Knows one package: this one, in its sources. */
inline std::string findPackage(const std::string& package)
{
  return package == "soft_tissue_sim" ? SOURCE_DIR : "";
}

/** Every place where `from` stands in `text`, replaced. */
inline std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
  {
    text.replace(at, from.size(), to);
  }
  return text;
}

/** What loading a scene file of this text complains of, with the folder's path as "DIR". */
inline std::string complaintAbout(const SceneFolder& folder, const std::string& text)
{
  try
  {
    loadSceneConfig(folder.write("scene.yaml", text), findPackage);
  }
  catch (const Error& error)
  {
    return replaced(error.what(), folder.path(), "DIR");
  }
  return "no complaint";
}

}  // namespace soft_tissue
