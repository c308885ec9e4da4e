#include "text_numbers.h"

#include <charconv>

namespace soft_tissue
{
namespace
{
std::string_view withoutPlus(std::string_view text)
{
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}
}  // namespace

std::string inQuotes(std::string_view text)
{
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest))
  {
    result += c >= ' ' && c <= '~' ? c : '?';
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

std::vector<std::string_view> splitWords(std::string_view line)
{
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();)
  {
    std::size_t end = i;
    while (end < line.size() && !isBlank(line[end]))
    {
      ++end;
    }
    if (end > i)
    {
      words.push_back(line.substr(i, end - i));
    }
    i = end + 1;
  }
  return words;
}

bool parseInteger(std::string_view text, long long& value)
{
  text = withoutPlus(text);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

bool parseReal(std::string_view text, double& value)
{
  text = withoutPlus(text);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ptr != text.data() + text.size())
  {
    return false;
  }
  if (result.ec == std::errc::result_out_of_range)  // too large is an error, too small rounds to 0
  {
    value = 0.0;
    return text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos;
  }
  return result.ec == std::errc();
}

std::string decimal(double value, int digits)
{
  char buffer[48];
  const auto end =
      std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::general, digits);
  return std::string(buffer, end.ptr);
}

}  // namespace soft_tissue
