#pragma once

#include <map>
#include <string>

#include "file_cursor.h"

namespace soft_tissue
{
/** One tag of an XML file; a closing tag's name starts with '/'. */
struct XmlTag
{
  std::string name;
  std::map<std::string, std::string> attributes;
  bool self_closing = false;

  /** The attribute's value, or the fallback if the tag has none of that name. */
  std::string attribute(const std::string& key, const std::string& fallback = "") const
  {
    const auto found = attributes.find(key);
    return found == attributes.end() ? fallback : found->second;
  }
};

/** Skips text, comments and declarations up to the next tag. @return false at the file's end */
bool nextXmlTag(FileCursor& cursor, XmlTag& tag);

}  // namespace soft_tissue
