#include "schema_item.h"

#include <yaml-cpp/yaml.h>

#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr std::size_t kLongestWritten = 60;

void write(const YAML::Node& node, std::string& out)
{
  if (out.size() > kLongestWritten)
  {
    return;
  }
  const char* separator = "";
  switch (node.Type())
  {
    case YAML::NodeType::Scalar:
      out += node.Scalar();
      break;
    case YAML::NodeType::Sequence:
      out += "[";
      for (const auto& element : node)
      {
        out += std::exchange(separator, ", ");
        write(element, out);
      }
      out += "]";
      break;
    case YAML::NodeType::Map:
      out += "{";
      for (const auto& pair : node)
      {
        out += std::exchange(separator, ", ");
        write(pair.first, out);
        out += ": ";
        write(pair.second, out);
      }
      out += "}";
      break;
    default:
      out += "nothing";
  }
}

/** Cuts at a character's border and shows line breaks as blanks. */
std::string oneShortLine(std::string text)
{
  if (text.size() > kLongestWritten)
  {
    std::size_t end = kLongestWritten;
    while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    {
      --end;
    }
    text.resize(end);
    text += "...";
  }
  for (char& c : text)
  {
    c = static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return text;
}

}  // namespace

Item::Item(const Document& document) : document_(&document), node_(document.root) {}

Item::Item(const Document& document, const YAML::Node& node, std::string path)
    : document_(&document), node_(std::make_shared<YAML::Node>(node)), path_(std::move(path))
{}

Item Item::at(const std::string& key) const
{
  return Item(*document_, (*node_)[key], pathOf(key));
}

Item Item::at(std::size_t index) const
{
  return Item(*document_, (*node_)[index], path_ + "[" + std::to_string(index) + "]");
}

bool Item::has(const std::string& key) const
{
  return isMap() && (*node_)[key].IsDefined();
}

bool Item::isMap() const
{
  return node_->IsMap();
}

bool Item::isList() const
{
  return node_->IsSequence();
}

bool Item::isScalar() const
{
  return node_->IsScalar();
}

bool Item::isPlain() const
{
  return node_->IsScalar() && node_->Tag() == "?";
}

std::size_t Item::size() const
{
  return node_->size();
}

std::vector<std::string> Item::keys() const
{
  std::vector<std::string> all;
  for (const auto& pair : *node_)
  {
    if (!pair.first.IsScalar())
    {
      reject("has a key that is not a word");
    }
    all.push_back(pair.first.Scalar());
  }
  return all;
}

const std::string& Item::scalar() const
{
  return node_->Scalar();
}

std::string Item::written() const
{
  std::string text;
  write(*node_, text);
  const bool quoted_blank = isScalar() && text.find_first_not_of(' ') == std::string::npos;
  return quoted_blank ? "'" + text + "'" : oneShortLine(text);
}

std::string Item::pathOf(const std::string& key) const
{
  return path_.empty() ? oneShortLine(key) : path_ + "." + oneShortLine(key);
}

void Item::rejectValue(const std::string& complaint) const
{
  if (path_.empty())
  {
    throw Error(document_->file + ": " + complaint);
  }
  throw Error(document_->file + ": " + path_ + " = " + written() + ", " + complaint);
}

void Item::reject(const std::string& complaint) const
{
  const std::string where = path_.empty() ? "" : path_ + ": ";
  throw Error(document_->file + ": " + where + complaint);
}

void Item::rejectKey(const std::string& key, const std::string& complaint) const
{
  throw Error(document_->file + ": " + pathOf(key) + ": " + complaint);
}

}  // namespace soft_tissue
