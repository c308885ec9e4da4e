#include "xml_tag.h"

namespace soft_tissue
{
namespace
{
/** Reads key="value" pairs from the inside of a tag. */
void readAttributes(FileCursor& cursor, std::string_view text, XmlTag& tag)
{
  const std::string_view blanks = " \t\r\n";
  std::size_t i = text.find_first_not_of(blanks);
  while (i < text.size())
  {
    const std::size_t equals = text.find('=', i);
    const std::size_t open = equals == std::string_view::npos ? equals : equals + 1;
    const char quote = open < text.size() ? text[open] : '\0';
    const std::size_t close = text.find(quote, open + 1);
    if ((quote != '"' && quote != '\'') || close == std::string_view::npos)
    {
      cursor.fail("the tag's attributes can't be read: " + inQuotes(text.substr(i)));
    }
    tag.attributes[std::string(text.substr(i, equals - i))] =
        std::string(text.substr(open + 1, close - open - 1));
    i = text.find_first_not_of(blanks, close + 1);
  }
}
}  // namespace

bool nextXmlTag(FileCursor& cursor, XmlTag& tag)
{
  const std::string_view bytes = cursor.bytes();
  while (true)
  {
    const std::size_t open = bytes.find('<', cursor.position());
    if (open == std::string_view::npos)
    {
      return false;
    }
    cursor.seek(open);
    if (bytes.substr(open, 4) == "<!--")
    {
      cursor.skipPast("-->");
      continue;
    }
    const std::size_t close = bytes.find('>', open);
    if (close == std::string_view::npos)
    {
      cursor.fail("the file ends inside a tag");
    }
    cursor.skip(close + 1 - open, "a tag");
    cursor.setMark(open);
    if (bytes[open + 1] == '?' || bytes[open + 1] == '!')
    {
      continue;
    }
    std::string_view inside = bytes.substr(open + 1, close - open - 1);
    tag = XmlTag();
    if (!inside.empty() && inside.back() == '/')
    {
      tag.self_closing = true;
      inside.remove_suffix(1);
    }
    const std::size_t name_end = std::min(inside.find_first_of(" \t\r\n"), inside.size());
    tag.name = std::string(inside.substr(0, name_end));
    readAttributes(cursor, inside.substr(name_end), tag);
    return true;
  }
}

}  // namespace soft_tissue
