#include <algorithm>

#include "schema_kinds.h"

namespace soft_tissue
{
namespace
{
bool isLetter(char c)
{
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool isWord(char c)
{
  return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
}

bool isRosName(const std::string& word)
{
  return !word.empty() && isLetter(word[0]) && std::all_of(word.begin(), word.end(), isWord);
}

bool isTopic(const std::string& word)
{
  std::size_t begin = 0;
  while (true)
  {
    const std::size_t slash = std::min(word.find('/', begin), word.size());
    if (!isRosName(word.substr(begin, slash - begin)))
    {
      return false;
    }
    if (slash == word.size())
    {
      return true;
    }
    begin = slash + 1;
  }
}

bool isFrame(const std::string& word)
{
  return !word.empty() && word[0] != '/' && word.find_first_of(" \t\n") == std::string::npos;
}

bool isPrefix(const std::string& word)
{
  return word.empty() || isFrame(word);
}

bool isAnything(const std::string& word)
{
  return !word.empty();
}

Kind<std::string> wordOf(const std::string& type, const std::string& allowed,
                         bool (*matches)(const std::string&))
{
  Kind<std::string> kind;
  kind.type = type;
  kind.allowed = allowed;
  kind.read = [=](const Item& item) {
    if (!item.isScalar() || !matches(item.scalar()))
    {
      item.rejectValue("must be " + described(type, allowed));
    }
    return item.scalar();
  };
  kind.show = [](const std::string& value) { return value; };
  return kind;
}

}  // namespace

Kind<std::string> name()
{
  return wordOf("name", "a letter, then letters, digits or _", isRosName);
}

Kind<std::string> text()
{
  return wordOf("text", "", isAnything);
}

Kind<std::string> topic()
{
  return wordOf("relative topic name", "names joined by /", isTopic);
}

Kind<std::string> frame()
{
  return wordOf("tf frame", "no leading / and no blanks", isFrame);
}

Kind<std::string> prefix()
{
  return wordOf("text", "no leading / and no blanks", isPrefix);
}

Kind<std::string> file()
{
  Kind<std::string> kind =
      wordOf("file", "path, package://PACKAGE/FILE or file:///PATH", isAnything);
  kind.read = [word = kind](const Item& item) { return resolveFile(item, word.read(item)); };
  return kind;
}

Kind<std::pair<std::string, std::string>> namePair()
{
  Kind<std::pair<std::string, std::string>> kind;
  kind.type = "list of 2 names";
  kind.allowed = "a soft body and what it touches, in any order";
  kind.read = [word = name()](const Item& item) {
    checkLength(item, 2, "2 names: a soft body and what it touches");
    return std::make_pair(word.read(item.at(0)), word.read(item.at(1)));
  };
  kind.show = [](const std::pair<std::string, std::string>& names) {
    return "[" + names.first + ", " + names.second + "]";
  };
  return kind;
}

}  // namespace soft_tissue
