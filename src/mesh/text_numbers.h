#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace soft_tissue
{
// Text and numbers without a locale: the same in every environment.

/** The text in quotes, cut to 40 characters, unprintable ones as '?'. */
std::string inQuotes(std::string_view text);

/** The words of a line. */
std::vector<std::string_view> splitWords(std::string_view line);

/** The text as a whole number. @return false if it is none or does not fit */
bool parseInteger(std::string_view text, long long& value);

/** The text as a number. @return false if it is none or does not fit */
bool parseReal(std::string_view text, double& value);

/** The number in its shortest form with at most that many significant digits. */
std::string decimal(double value, int digits = 6);

/** True for the white space that separates words. */
inline bool isBlank(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace soft_tissue
