#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "text_numbers.h"

namespace soft_tissue
{
/** A file's bytes and a place in them; every failure names the file and that place. */
class FileCursor
{
 public:
  /** Reads the whole file. @throws Error if it is missing, no regular file, unreadable or empty */
  explicit FileCursor(const std::string& path);

  const std::string& path() const { return path_; }
  std::string_view bytes() const { return bytes_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

  /** Goes to a byte offset, which must not lie behind the end. */
  void seek(std::size_t position) { position_ = mark_ = position; }

  /** Makes failures speak of this byte offset. */
  void setMark(std::size_t position) { mark_ = position; }
  std::size_t mark() const { return mark_; }

  /** From this character to the line's end is a comment between words. */
  void setComment(char comment) { comment_ = comment; }

  /** Words also end before this character. */
  void setWordBreak(char word_break) { word_break_ = word_break; }

  /** Whether value() reads raw bytes (then failures tell byte offsets, not lines), and swaps them.
   */
  void setBinary(bool binary, bool swap_bytes)
  {
    binary_ = binary;
    swap_bytes_ = swap_bytes;
  }
  bool binary() const { return binary_; }

  /** @throws Error "<path>:<line>: <reason>", or "<path>: byte <offset>: <reason>" in a binary file
   */
  [[noreturn]] void fail(const std::string& reason) const;

  /** True if nothing but white space and comments is left. */
  bool atEnd();

  /** The next white-space separated word. @throws Error at the end of the file */
  std::string_view word(const char* what);

  /** The next word without going past it; empty at the end. */
  std::string_view peek();

  /** From here to the end of the line, which is consumed. */
  std::string_view restOfLine();

  /** Goes to the next line, where raw bytes start. @throws Error if words are left on this one */
  void endLine();

  /** Takes the next word. @throws Error if it is another */
  void expect(std::string_view expected);

  /** The next number, from text or raw bytes as setBinary() says. @throws Error naming `what` */
  template <typename T>
  T value(const char* what)
  {
    if (binary_)
    {
      return raw<T>(what);
    }
    if constexpr (std::is_floating_point_v<T>)
    {
      return static_cast<T>(real(what));
    }
    else
    {
      using Limits = std::numeric_limits<T>;
      constexpr long long kMax = sizeof(T) < 8 ? static_cast<long long>(Limits::max())
                                               : std::numeric_limits<long long>::max();
      return static_cast<T>(integer(what, static_cast<long long>(Limits::min()), kMax));
    }
  }

  /** The next raw value, bytes swapped if setBinary() asked for it. @throws Error at the end */
  template <typename T>
  T raw(const char* what)
  {
    need(sizeof(T), what);
    char buffer[sizeof(T)];
    std::memcpy(buffer, bytes_.data() + position_, sizeof(T));
    if (swap_bytes_)
    {
      std::reverse(buffer, buffer + sizeof(T));
    }
    T result;
    std::memcpy(&result, buffer, sizeof(T));
    position_ += sizeof(T);
    return result;
  }

  /** The next word as a whole number. @throws Error if it is none or outside [min, max] */
  long long integer(const char* what, long long min, long long max);

  /** The next word as a number, which may be infinite or NaN. @throws Error if it is none */
  double real(const char* what);

  /** Checks a declared count against what the rest of the file can hold. @throws Error if it can't
   */
  std::size_t checkedCount(long long count, std::size_t bytes_each, const char* what) const;

  /** Skips raw bytes. @throws Error if fewer are left */
  void skip(std::size_t count, const char* what);

  /** Goes behind the next occurrence of `text`. @throws Error if there is none */
  void skipPast(std::string_view text);

 private:
  void need(std::size_t count, const char* what);
  void skipBlanks();

  std::string path_;
  std::string bytes_;
  std::size_t position_ = 0;
  std::size_t mark_ = 0;
  char comment_ = '\0';
  char word_break_ = '\0';
  bool binary_ = false;
  bool swap_bytes_ = false;
};

/** True if the machine stores the least significant byte first. */
bool littleEndianMachine();

}  // namespace soft_tissue
