#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/config.h"

namespace YAML
{
class Node;
}

namespace soft_tissue
{
/** One YAML file as read, with what is needed to resolve the names in it. */
struct Document
{
  std::string file;    ///< as the user named it, for messages
  std::string folder;  ///< absolute; relative names start here
  PackageResolver resolver = nullptr;
  std::shared_ptr<const YAML::Node> root;
};

/** A value in a document that knows where it stands, so that every complaint about it can say so.
 */
class Item
{
 public:
  explicit Item(const Document& document);

  /** The value of a key; the item must be a map that has it. */
  Item at(const std::string& key) const;

  /** An element; the item must be a list that is long enough. */
  Item at(std::size_t index) const;

  bool has(const std::string& key) const;
  bool isMap() const;
  bool isList() const;

  /** Whether it is one word, number or text. */
  bool isScalar() const;

  /** Whether it is a scalar without quotes and tags, which make a text of a number. */
  bool isPlain() const;

  /** Number of elements of a list or keys of a map. */
  std::size_t size() const;

  /** Keys of a map in the file's order. @throws Error for a key that is not a word */
  std::vector<std::string> keys() const;

  /** Text of a scalar; empty for anything else. */
  const std::string& scalar() const;

  const Document& document() const { return *document_; }
  const std::string& path() const { return path_; }

  /** The value in one line as the file has it, cut when long. */
  std::string written() const;

  /** Path of a key below this item, e.g. "tissues[0].mesh". */
  std::string pathOf(const std::string& key) const;

  /** Throws Error "file: path = value, complaint". */
  [[noreturn]] void rejectValue(const std::string& complaint) const;

  /** Throws Error "file: path: complaint". */
  [[noreturn]] void reject(const std::string& complaint) const;

  /** Throws Error "file: path.key: complaint". */
  [[noreturn]] void rejectKey(const std::string& key, const std::string& complaint) const;

 private:
  Item(const Document& document, const YAML::Node& node, std::string path);

  const Document* document_;
  std::shared_ptr<const YAML::Node> node_;
  std::string path_;
};

/**
 * Reads a YAML file of one document.
 * @throws Error for a file that can't be read, is not UTF-8, is empty or is not YAML
 */
Document readDocument(const std::string& file, PackageResolver resolver);

/**
 * Turns a file name in a document into an absolute path of a readable file: package://package/rest,
 * file:///path, an absolute path, or a path relative to the document's folder. The item is what
 * names the file, or what needs it.
 * @throws Error naming the item and the path it came to
 */
std::string resolveFile(const Item& item, const std::string& name);

}  // namespace soft_tissue
