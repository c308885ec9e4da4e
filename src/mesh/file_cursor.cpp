#include "file_cursor.h"

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
FileCursor::FileCursor(const std::string& path) : path_(path)
{
  std::error_code status;
  if (!std::filesystem::exists(path, status))
  {
    throw Error(path + ": no such file");
  }
  if (!std::filesystem::is_regular_file(path, status))
  {
    throw Error(path + ": is not a regular file");
  }
  std::ifstream in(path, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(path, status);
  if (!in || status)
  {
    throw Error(path + ": can't be opened for reading");
  }
  bytes_.resize(size);
  in.read(bytes_.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size)
  {
    throw Error(path + ": can't be read to its end");
  }
  if (bytes_.empty())
  {
    throw Error(path + ": is empty (0 bytes)");
  }
  if (bytes_.compare(0, 3, "\xEF\xBB\xBF") == 0)
  {
    seek(3);  // the byte-order mark some editors write before UTF-8 text
  }
}

void FileCursor::fail(const std::string& reason) const
{
  if (binary_)
  {
    throw Error(path_ + ": byte " + std::to_string(mark_) + ": " + reason);
  }
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(mark_, bytes_.size()));
  const auto line = 1 + std::count(bytes_.begin(), end, '\n');
  throw Error(path_ + ":" + std::to_string(line) + ": " + reason);
}

void FileCursor::skipBlanks()
{
  while (position_ < bytes_.size())
  {
    if (comment_ != '\0' && bytes_[position_] == comment_)
    {
      position_ = std::min(bytes_.find('\n', position_), bytes_.size());
    }
    else if (isBlank(bytes_[position_]))
    {
      ++position_;
    }
    else
    {
      return;
    }
  }
}

bool FileCursor::atEnd()
{
  skipBlanks();
  return position_ == bytes_.size();
}

std::string_view FileCursor::word(const char* what)
{
  skipBlanks();
  mark_ = position_;
  if (position_ == bytes_.size())
  {
    fail(std::string("the file ends where ") + what + " should follow");
  }
  std::size_t end = position_ + 1;
  while (end < bytes_.size() && !isBlank(bytes_[end]) &&
         (word_break_ == '\0' || bytes_[end] != word_break_))
  {
    ++end;
  }
  const std::string_view result(bytes_.data() + position_, end - position_);
  position_ = end;
  return result;
}

std::string_view FileCursor::peek()
{
  if (atEnd())
  {
    return {};
  }
  const std::size_t here = position_;
  const std::string_view result = word("a word");
  position_ = here;
  return result;
}

std::string_view FileCursor::restOfLine()
{
  mark_ = position_;
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view line(bytes_.data() + position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r')
  {
    line.remove_suffix(1);
  }
  return line;
}

void FileCursor::endLine()
{
  if (!splitWords(restOfLine()).empty())
  {
    fail("expected the end of the line");
  }
}

void FileCursor::expect(std::string_view expected)
{
  const std::string name = inQuotes(expected);
  const std::string_view found = word(name.c_str());
  if (found != expected)
  {
    fail("expected " + name + ", found " + inQuotes(found));
  }
}

long long FileCursor::integer(const char* what, long long min, long long max)
{
  const std::string_view text = word(what);
  long long value = 0;
  if (!parseInteger(text, value))
  {
    fail(std::string(what) + " must be a whole number, found " + inQuotes(text));
  }
  if (value < min || value > max)
  {
    fail(std::string(what) + " = " + std::to_string(value) + ", must be in [" +
         std::to_string(min) + ", " + std::to_string(max) + "]");
  }
  return value;
}

double FileCursor::real(const char* what)
{
  const std::string_view text = word(what);
  double value = 0.0;
  if (!parseReal(text, value))
  {
    fail(std::string(what) + " must be a number, found " + inQuotes(text));
  }
  return value;
}

std::size_t FileCursor::checkedCount(long long count, std::size_t bytes_each,
                                     const char* what) const
{
  if (count < 0 || static_cast<unsigned long long>(count) > remaining() / bytes_each ||
      count > std::numeric_limits<int>::max() / 4)
  {
    fail("declares " + std::to_string(count) + " " + what + ", but only " +
         std::to_string(remaining()) + " bytes follow");
  }
  return static_cast<std::size_t>(count);
}

void FileCursor::skip(std::size_t count, const char* what)
{
  need(count, what);
  position_ += count;
}

void FileCursor::skipPast(std::string_view text)
{
  const std::size_t found = bytes_.find(text, position_);
  if (found == std::string::npos)
  {
    fail("the file ends before " + inQuotes(text));
  }
  position_ = found + text.size();
}

void FileCursor::need(std::size_t count, const char* what)
{
  mark_ = position_;
  if (remaining() < count)
  {
    fail(std::string("the file ends where ") + what + " should follow");
  }
}

bool littleEndianMachine()
{
  const std::uint16_t one = 1;
  char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

}  // namespace soft_tissue
