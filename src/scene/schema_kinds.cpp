#include "schema_kinds.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace soft_tissue
{
const char* const kNotAvailable = "not available in version 0.1; see docs/limits.md";

std::string shortest(double value)
{
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return std::string(digits, end);
}

std::string joined(const std::vector<std::string>& words)
{
  std::string all;
  for (const std::string& word : words)
  {
    all += (all.empty() ? "" : ", ") + word;
  }
  return all;
}

std::string described(const std::string& type, const std::string& allowed)
{
  const bool goes_on =
      allowed.empty() || allowed.rfind("in ", 0) == 0 || allowed.rfind("of ", 0) == 0;
  return "a " + type + (goes_on ? "" : ":") + (allowed.empty() ? "" : " " + allowed);
}

namespace
{
std::string listed(const Vec3& v)
{
  return "[" + shortest(v.x()) + ", " + shortest(v.y()) + ", " + shortest(v.z()) + "]";
}

double readNumber(const Item& item, const std::string& allowed)
{
  const std::string must = "must be a number" + (allowed.empty() ? "" : " " + allowed);
  if (!item.isPlain())
  {
    item.rejectValue(must);
  }
  const std::string& digits = item.scalar();
  const char* begin = digits.data() + (digits.size() > 1 && digits[0] == '+' && digits[1] != '-');
  const char* end = digits.data() + digits.size();
  double value = 0.0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ptr == end && result.ec == std::errc::result_out_of_range)
  {
    item.rejectValue("does not fit a double; " + must);
  }
  const bool yaml_special = digits.find(".inf") != std::string::npos ||
                            digits.find(".Inf") != std::string::npos || digits == ".nan" ||
                            digits == ".NaN";
  if (yaml_special || (result.ptr == end && result.ec == std::errc() && !std::isfinite(value)))
  {
    item.rejectValue("must be a finite number" + (allowed.empty() ? "" : " " + allowed));
  }
  if (result.ec != std::errc() || result.ptr != end)
  {
    item.rejectValue(must);
  }
  return value;
}

Vec3 readVector(const Item& item)
{
  checkLength(item, 3, "3 numbers");
  Vec3 v;
  for (std::size_t i = 0; i < 3; ++i)
  {
    v[static_cast<Eigen::Index>(i)] = readNumber(item.at(i), "");
  }
  return v;
}

/** Three numbers, each of them of the kind given. */
Kind<Vec3> vectorOf(const Kind<double>& entry)
{
  Kind<Vec3> kind;
  kind.type = "list of 3 numbers";
  kind.allowed = "each " + entry.allowed;
  kind.read = [entry](const Item& item) {
    checkLength(item, 3, "3 numbers");
    return Vec3(entry.read(item.at(0)), entry.read(item.at(1)), entry.read(item.at(2)));
  };
  kind.show = listed;
  return kind;
}

}  // namespace

void checkLength(const Item& item, std::size_t length, const std::string& what)
{
  if (!item.isList() || item.size() != length)
  {
    item.rejectValue("must be a list of " + what);
  }
}

bool Range::holds(double value) const
{
  const bool above = ends == Ends::closed ? value >= low : value > low;
  const bool below = ends == Ends::open ? value < high : value <= high;
  return above && below;
}

std::string Range::text() const
{
  return std::string("in ") + (ends == Ends::closed ? "[" : "(") + shortest(low) + ", " +
         shortest(high) + (ends == Ends::open ? ")" : "]");
}

Kind<double> number(const Range& range)
{
  Kind<double> kind;
  kind.type = "number";
  kind.allowed = range.text();
  kind.read = [range](const Item& item) {
    const double value = readNumber(item, range.text());
    if (!range.holds(value))
    {
      item.rejectValue("must be " + range.text());
    }
    return value;
  };
  kind.show = shortest;
  return kind;
}

Kind<double> number(double low, double high, Ends ends)
{
  return number(Range{low, high, ends});
}

Kind<int> integer(int low, int high)
{
  Kind<int> kind;
  kind.type = "whole number";
  kind.allowed = "in [" + std::to_string(low) + ", " + std::to_string(high) + "]";
  kind.read = [=, allowed = kind.allowed](const Item& item) {
    const double value = readNumber(item, allowed);
    if (value != std::floor(value))
    {
      item.rejectValue("must be a whole number " + allowed);
    }
    if (value < low || value > high)
    {
      item.rejectValue("must be " + allowed);
    }
    return static_cast<int>(value);
  };
  kind.show = [](const int& value) { return std::to_string(value); };
  return kind;
}

Kind<bool> boolean()
{
  Kind<bool> kind = choice<bool>({{"true", true}, {"false", false}});
  kind.type = "true or false";
  kind.allowed.clear();
  return kind;
}

Kind<Vec3> vector(double bound)
{
  return vectorOf(number(-bound, bound, Ends::closed));
}

Kind<Vec3> vectorOfNorm(double bound)
{
  Kind<Vec3> kind;
  kind.type = "list of 3 numbers";
  kind.allowed = "of magnitude at most " + shortest(bound);
  kind.read = [bound, allowed = kind.allowed](const Item& item) {
    const Vec3 v = readVector(item);
    if (!(v.stableNorm() <= bound))
    {
      item.rejectValue("must be " + allowed);
    }
    return v;
  };
  kind.show = listed;
  return kind;
}

Kind<Vec3> edgeLengths()
{
  return vectorOf(number(0.0, 10.0, Ends::open));
}

Kind<double> factor(double bound)
{
  Kind<double> factor = number(-bound, bound, Ends::closed);
  factor.allowed += " and not 0";
  factor.read = [range = factor](const Item& item) {
    const double value = range.read(item);
    if (value == 0.0)
    {
      item.rejectValue("must be " + range.allowed);
    }
    return value;
  };
  return factor;
}

Kind<Vec3> factors()
{
  return vectorOf(factor(1000.0));
}

Kind<BoxConfig> box()
{
  const Kind<Vec3> corner = vector(1000.0);
  Kind<BoxConfig> kind;
  kind.type = "list of 2 corners";
  kind.allowed = "[[x, y, z] least, [x, y, z] greatest], " + corner.allowed;
  kind.read = [corner](const Item& item) {
    checkLength(item, 2, "2 corners, each a list of 3 numbers");
    const BoxConfig box{corner.read(item.at(0)), corner.read(item.at(1))};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
      if (box.min[axis] > box.max[axis])
      {
        const auto k = static_cast<std::size_t>(axis);
        item.at(0).at(k).rejectValue("must be at most " + item.at(1).at(k).path() + " = " +
                                     item.at(1).at(k).written());
      }
    }
    return box;
  };
  kind.show = [](const BoxConfig& box) {
    return "[" + listed(box.min) + ", " + listed(box.max) + "]";
  };
  return kind;
}

Kind<std::pair<double, double>> numberRange(double high)
{
  const Kind<double> end = number(0.0, high, Ends::open_below);
  Kind<std::pair<double, double>> kind;
  kind.type = "list of 2 numbers";
  kind.allowed = "[least, greatest], each " + end.allowed;
  kind.read = [end](const Item& item) {
    checkLength(item, 2, "2 numbers");
    const auto range = std::make_pair(end.read(item.at(0)), end.read(item.at(1)));
    if (range.first > range.second)
    {
      item.rejectValue("must be [least, greatest]");
    }
    return range;
  };
  kind.show = [](const std::pair<double, double>& range) {
    return "[" + shortest(range.first) + ", " + shortest(range.second) + "]";
  };
  return kind;
}

std::size_t readChoice(const Item& item, const std::vector<std::string>& words,
                       const std::vector<std::string>& later)
{
  const std::string word = item.isScalar() ? item.scalar() : "";
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    if (words[i] == word)
    {
      return i;
    }
  }
  for (const std::string& known : later)
  {
    if (known == word)
    {
      item.rejectValue(std::string(kNotAvailable) + "; must be " + joined(words));
    }
  }
  item.rejectValue(words.size() == 1 ? "must be " + words[0] : "must be one of " + joined(words));
}

}  // namespace soft_tissue
