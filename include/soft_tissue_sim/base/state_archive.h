#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * A state as bytes, in sections that have names: what belongs together calls section(), and then
 * the same functions for what it has, whether the archive is written or read.
 *
 * The bytes have their version, what they are a state of, and a checksum in them. Numbers are as
 * this kind of machine has them in memory, so no bit is lost.
 */
class StateArchive
{
 public:
  /** To be written. @param owner  a number that only what may read it again has */
  explicit StateArchive(std::uint64_t owner);
  /** To be read. @throws Error for what is no state, damaged, of another version or owner */
  StateArchive(const std::string& bytes, std::uint64_t owner);

  bool reading() const { return reading_; }

  /** What follows, until the next one, belongs to a section of its own. @throws Error on reading if
   * there is none of that name, or the one before has more than was read */
  void section(const std::string& name);

  /** A number, or a struct of numbers without gaps. */
  template <typename T>
  void value(T& what)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    exchange(&what, sizeof(T));
  }
  void value(bool& what);
  void value(Vec3& what) { exchange(what.data(), sizeof(Vec3)); }
  void value(Mat3& what) { exchange(what.data(), sizeof(Mat3)); }
  void value(Pose& what) { exchange(what.data(), 16 * sizeof(double)); }

  /** As many as there are. @throws Error on reading if others were written */
  template <typename T, typename Allocator>
  void values(std::vector<T, Allocator>& what)
  {
    std::uint64_t size = what.size();
    value(size);
    checkSize(size, what.size());
    exchangeAll(what);
  }
  /** However many. */
  template <typename T, typename Allocator>
  void list(std::vector<T, Allocator>& what)
  {
    std::uint64_t size = what.size();
    value(size);
    if (reading_)
    {
      checkRoom(size, sizeof(T));
      what.resize(size);
    }
    exchangeAll(what);
  }

  /** Ends writing. */
  std::string bytes();
  /** Ends reading. @throws Error if anything was not read */
  void finish();

 private:
  template <typename T>
  static constexpr bool kPlain = std::is_trivially_copyable_v<T> || std::is_same_v<T, Vec3>;

  template <typename T, typename Allocator>
  void exchangeAll(std::vector<T, Allocator>& what)
  {
    static_assert(kPlain<T>);
    exchange(what.data(), what.size() * sizeof(T));
  }
  void exchange(void* data, std::size_t size);
  void checkSize(std::uint64_t found, std::size_t expected) const;
  void checkRoom(std::uint64_t count, std::size_t each) const;
  void closeSection() const;

  bool reading_;
  std::uint64_t owner_;
  std::map<std::string, std::string> sections_;
  std::string name_;
  std::string* section_ = nullptr;  ///< the current one
  std::size_t at_ = 0;              ///< in it, on reading
  std::size_t opened_ = 0;
};

/** A file as bytes, and back. @throws Error naming the file */
std::string readBytes(const std::string& file);
/** Writes beside it first: a file that is there is either the old or the new one. */
void writeBytes(const std::string& file, const std::string& bytes);

}  // namespace soft_tissue
