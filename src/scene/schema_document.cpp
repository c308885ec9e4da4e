#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "schema_item.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr std::uintmax_t kLargestFile = 64U << 20U;

std::string textOf(const std::string& file)
{
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
  {
    throw Error(file + ": no such file");
  }
  if (!std::filesystem::is_regular_file(file, ignored))
  {
    throw Error(file + ": is a folder or device, must be a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (size > kLargestFile)
  {
    throw Error(file + ": has " + std::to_string(size) + " bytes, must be at most " +
                std::to_string(kLargestFile));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream.good() && !stream.eof())
  {
    throw Error(file + ": can't be read");
  }
  return bytes;
}

/** Number of bytes of the UTF-8 character at `at`; 0 when the bytes there are none. */
std::size_t utf8Length(const std::string& bytes, std::size_t at)
{
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  const std::uint32_t lead = byte(at);
  if (lead < 0x80)
  {
    return 1;
  }
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i)
  {
    if ((byte(at + i) & 0xC0U) != 0x80U)
    {
      return 0;
    }
    code = code << 6U | (byte(at + i) & 0x3FU);
  }
  const std::uint32_t smallest = length == 2 ? 0x80U : length == 3 ? 0x800U : 0x10000U;
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return lead < 0xC0 || lead > 0xF4 || code < smallest || code > 0x10FFFF || surrogate ? 0 : length;
}

/** Refuses what yaml-cpp would let through or stop at without a word. */
void checkText(const std::string& file, const std::string& bytes)
{
  for (std::size_t at = 0; at < bytes.size();)
  {
    const std::size_t length = utf8Length(bytes, at);
    const auto byte = static_cast<unsigned char>(bytes[at]);
    const bool control =
        (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F;
    if (length == 0 || control)
    {
      char hex[8];
      std::snprintf(hex, sizeof hex, "0x%02x", byte);
      throw Error(file + ": byte " + std::to_string(at) + " is " + hex +
                  (control ? ", a control character; YAML allows only tab and line ends"
                           : ", which is not UTF-8; save the file as UTF-8"));
    }
    at += length;
  }
}

}  // namespace

Document readDocument(const std::string& file, PackageResolver resolver)
{
  const std::string bytes = textOf(file);
  checkText(file, bytes);
  Document document;
  document.file = file;
  document.folder = std::filesystem::absolute(file).parent_path().string();
  document.resolver = resolver;
  try
  {
    const std::vector<YAML::Node> parts = YAML::LoadAll(bytes);
    if (parts.empty() || (parts.size() == 1 && parts.front().IsNull()))
    {
      throw Error(file + ": is empty");
    }
    if (parts.size() > 1)
    {
      throw Error(file + ": has " + std::to_string(parts.size()) +
                  " YAML documents, must have one; remove the '---' lines");
    }
    document.root = std::make_shared<YAML::Node>(parts.front());
  }
  catch (const YAML::Exception& error)
  {
    throw Error(file + ": line " + std::to_string(error.mark.line + 1) + ", column " +
                std::to_string(error.mark.column + 1) + ": " + error.msg);
  }
  return document;
}

std::string resolveFile(const Item& item, const std::string& name)
{
  namespace fs = std::filesystem;
  const auto startsWith = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
  const std::string about = item.scalar() == name ? "" : "needs " + name + ": ";
  const auto reject = [&](const std::string& complaint) { item.rejectValue(about + complaint); };
  fs::path path;
  if (startsWith("package://"))
  {
    const std::string rest = name.substr(10);
    const std::string package = rest.substr(0, rest.find('/'));
    if (package.empty() || package.size() + 1 >= rest.size())
    {
      reject("must be package://PACKAGE/FILE");
    }
    if (item.document().resolver == nullptr)
    {
      reject("package:// names can't be found without ROS; use a path");
    }
    const std::string folder = item.document().resolver(package);
    if (folder.empty())
    {
      reject("ROS finds no package '" + package + "'");
    }
    path = fs::path(folder) / rest.substr(package.size() + 1);
  }
  else if (startsWith("file://"))
  {
    path = name.substr(7);
    if (!path.is_absolute())
    {
      reject("must be file:///ABSOLUTE/PATH");
    }
  }
  else if (name.find("://") != std::string::npos)
  {
    reject("must be a path, package://PACKAGE/FILE or file:///PATH");
  }
  else
  {
    path = fs::path(item.document().folder) / name;
  }
  path = path.lexically_normal();
  std::error_code ignored;
  if (!fs::exists(path, ignored))
  {
    reject("no such file: " + path.string());
  }
  if (!fs::is_regular_file(path, ignored))
  {
    reject("is a folder or device, must be a file: " + path.string());
  }
  if (!std::ifstream(path).good())
  {
    reject("can't be read: " + path.string());
  }
  return path.string();
}

}  // namespace soft_tissue
