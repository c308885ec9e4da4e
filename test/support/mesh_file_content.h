#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::test
{
/** A file's content under construction: values as words or as raw bytes. */
class Content
{
 public:
  explicit Content(bool binary = false, bool high_byte_first = false)
      : binary_(binary), swap_(high_byte_first)
  {}

  Content& text(const std::string& words)
  {
    out_ += words;
    return *this;
  }

  template <typename T>
  Content& value(T number)
  {
    if (binary_)
    {
      char bytes[sizeof(T)];
      std::memcpy(bytes, &number, sizeof(T));
      if (swap_)
      {
        std::reverse(bytes, bytes + sizeof(T));
      }
      out_.append(bytes, sizeof(T));
      return *this;
    }
    std::ostringstream word;
    word.precision(17);
    word << +number << ' ';
    out_ += word.str();
    return *this;
  }

  template <typename T>
  Content& point(const Vec3& p)
  {
    return value(static_cast<T>(p.x())).value(static_cast<T>(p.y())).value(static_cast<T>(p.z()));
  }

  const std::string& str() const { return out_; }

 private:
  std::string out_;
  bool binary_;
  bool swap_;
};

/** A folder for a test's files, removed at the end. */
class ScratchFolder
{
 public:
  ScratchFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "mesh_test_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /** Writes a file and returns its path. */
  std::string write(const std::string& name, const std::string& content) const
  {
    const std::string path = (path_ / name).string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/** One mesh as one file of some format; TetGen needs a second file. */
struct SampleFile
{
  std::string format;  ///< as LoadReport names it
  std::string name;
  std::string content;
  std::string partner_name;
  std::string partner;
};

}  // namespace soft_tissue::test
