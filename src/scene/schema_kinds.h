#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schema_item.h"

namespace soft_tissue
{
class SectionBase;

/** What a value of type V looks like in a file: how it is read and checked, and how it is told. */
template <class V>
struct Kind
{
  std::string type;     ///< e.g. "number"
  std::string allowed;  ///< e.g. "in (-1, 0.5)"; empty when everything of the type is
  std::function<V(const Item&)> read;
  std::function<std::string(const V&)> show;
  const SectionBase* section = nullptr;  ///< keys of the value, if it is a map or a list of maps
};

enum class Ends
{
  closed,      ///< [low, high]
  open,        ///< (low, high)
  open_below,  ///< (low, high]
};

/** The shortest text that reads back as the same number. */
std::string shortest(double value);

/** "a number in (-1, 0.5)" of a type and what of it is allowed. */
std::string described(const std::string& type, const std::string& allowed);

/** Numbers that are allowed. */
struct Range
{
  double low = 0.0, high = 0.0;
  Ends ends = Ends::closed;

  bool holds(double value) const;
  std::string text() const;  ///< "in (-1, 0.5)"
};

Kind<double> number(const Range& range);
Kind<double> number(double low, double high, Ends ends);
Kind<int> integer(int low, int high);
Kind<bool> boolean();

/** ROS name of a tissue or tool, which becomes a namespace. */
Kind<std::string> name();

/** Text of at least one character. */
Kind<std::string> text();

/** Name of an existing file, resolved to an absolute path. */
Kind<std::string> file();

/** Relative ROS topic name. */
Kind<std::string> topic();

/** Name of a tf frame. */
Kind<std::string> frame();

/** What stands before the names of tf frames; may be empty. */
Kind<std::string> prefix();

/** A number in [-bound, bound], not zero. */
Kind<double> factor(double bound);

/** Three numbers, each in [-bound, bound]. */
Kind<Vec3> vector(double bound);

/** Three numbers whose norm is at most `bound`. */
Kind<Vec3> vectorOfNorm(double bound);

/** Three edge lengths in (0, 10) m. */
Kind<Vec3> edgeLengths();

/** Three factors, none of them zero. */
Kind<Vec3> factors();

/** Two opposite corners, least first. */
Kind<BoxConfig> box();

/** Lower and upper end of a range of numbers in (0, high]. */
Kind<std::pair<double, double>> numberRange(double high);

/** Two names in a list. */
Kind<std::pair<std::string, std::string>> namePair();

/** A list item as the file has it must be a list of `length` elements. */
void checkLength(const Item& item, std::size_t length, const std::string& what);

/** What is said of a feature that the schema knows and this version does not have. */
extern const char* const kNotAvailable;

/** "a, b, c" */
std::string joined(const std::vector<std::string>& words);

/** The index of the item's word among `words`; words in `later` are known, but not available. */
std::size_t readChoice(const Item& item, const std::vector<std::string>& words,
                       const std::vector<std::string>& later);

/** One word of several, each standing for a value. */
template <class E>
Kind<E> choice(std::vector<std::pair<std::string, E>> choices, std::vector<std::string> later = {})
{
  std::vector<std::string> words;
  for (const auto& option : choices)
  {
    words.push_back(option.first);
  }
  Kind<E> kind;
  kind.type = "word";
  kind.allowed = joined(words);
  kind.read = [choices, words, later](const Item& item) {
    return choices[readChoice(item, words, later)].second;
  };
  kind.show = [choices](const E& value) {
    for (const auto& option : choices)
    {
      if (option.second == value)
      {
        return option.first;
      }
    }
    return std::string();
  };
  return kind;
}

/** A value that may be left out; `absent` tells what holds then, and may be written as well. */
template <class V>
Kind<std::optional<V>> maybe(const Kind<V>& kind, const std::string& absent, bool may_be_written)
{
  Kind<std::optional<V>> result;
  result.type = may_be_written ? kind.type + " or " + absent : kind.type;
  result.allowed = kind.allowed;
  result.read = [kind, absent, may_be_written](const Item& item) -> std::optional<V> {
    if (may_be_written && item.isScalar() && item.scalar() == absent)
    {
      return std::nullopt;
    }
    return kind.read(item);
  };
  result.show = [kind, absent](const std::optional<V>& value) {
    return value ? kind.show(*value) : absent;
  };
  result.section = kind.section;
  return result;
}

/** A list of values of one kind; a single one may stand without the list when `or_one`. */
template <class V>
Kind<std::vector<V>> listOf(const Kind<V>& kind, std::size_t at_least = 0, bool or_one = false)
{
  Kind<std::vector<V>> result;
  result.type = (or_one ? kind.type + " or list of " : "list of ") + kind.type + "s";
  result.allowed = at_least > 0 && !or_one ? "at least " + std::to_string(at_least) : "";
  result.read = [kind, at_least, or_one](const Item& item) {
    std::vector<V> values;
    if (or_one && !item.isList())
    {
      values.push_back(kind.read(item));
      return values;
    }
    if (!item.isList())
    {
      item.rejectValue("must be a list");
    }
    const std::size_t size = item.size();
    if (size < at_least)
    {
      item.reject("is an empty list, must have at least " + std::to_string(at_least));
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      values.push_back(kind.read(item.at(i)));
    }
    return values;
  };
  result.show = [](const std::vector<V>& values) {
    return values.empty() ? std::string("[]") : std::string();
  };
  result.section = kind.section;
  return result;
}

/** A value read as V and made into a W with a function of the item and the V. */
template <class V, class Make>
auto madeFrom(const Kind<V>& kind, Make make)
{
  using W = decltype(make(std::declval<const Item&>(), std::declval<const V&>()));
  Kind<W> result;
  result.type = kind.type;
  result.allowed = kind.allowed;
  result.read = [kind, make](const Item& item) { return make(item, kind.read(item)); };
  result.show = [](const W&) { return std::string(); };
  result.section = kind.section;
  return result;
}

}  // namespace soft_tissue
