#include "soft_tissue_sim/base/state_archive.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/hash.h"

namespace soft_tissue
{
namespace
{
const std::string kMagic = "soft_tissue_sim state\n";
constexpr std::uint32_t kVersion = 1;

std::uint64_t checksum(const std::string& bytes, std::size_t size)
{
  StateHash hash;
  hash.add(bytes.data(), size);
  return hash.value();
}

template <typename T>
void append(const T& value, std::string& bytes)
{
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void append(const std::string& text, std::string& bytes)
{
  append(static_cast<std::uint64_t>(text.size()), bytes);
  bytes += text;
}

/** @throws Error for what is there, but no file: pipes make wait, devices never end, and must not
 * be replaced */
void checkFile(const std::string& path)
{
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
  {
    throw Error(path + ": is no file");
  }
}

/** What stands in bytes, piece after piece. */
class Cursor
{
 public:
  Cursor(const std::string& bytes, std::size_t at, std::size_t end)
      : bytes_(bytes), at_(at), end_(end)
  {}

  template <typename T>
  T take()
  {
    T value{};
    const std::string piece = take(sizeof(T));
    std::memcpy(&value, piece.data(), sizeof(T));
    return value;
  }

  std::string takeText() { return take(take<std::uint64_t>()); }
  bool done() const { return at_ == end_; }

 private:
  std::string take(std::uint64_t size)
  {
    if (size > end_ - at_)
    {
      throw Error("is damaged: a part of it reaches beyond its end");
    }
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  const std::string& bytes_;
  std::size_t at_, end_;
};
}  // namespace

StateArchive::StateArchive(std::uint64_t owner) : reading_(false), owner_(owner) {}

StateArchive::StateArchive(const std::string& bytes, std::uint64_t owner)
    : reading_(true), owner_(owner)
{
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (bytes.compare(0, kMagic.size(), kMagic) != 0)
  {
    throw Error("is no saved state");
  }
  const std::size_t end = bytes.size() < kMagic.size() + kSum ? 0 : bytes.size() - kSum;
  if (end == 0 || checksum(bytes, end) != Cursor(bytes, end, bytes.size()).take<std::uint64_t>())
  {
    throw Error("is damaged: its checksum is not that of what it holds; truncated?");
  }
  Cursor cursor(bytes, kMagic.size(), end);
  const auto version = cursor.take<std::uint32_t>();
  if (version != kVersion)
  {
    throw Error("has format version " + std::to_string(version) + ", must be " +
                std::to_string(kVersion));
  }
  if (cursor.take<std::uint64_t>() != owner_)
  {
    throw Error("is the state of another scene");
  }
  while (!cursor.done())
  {
    const std::string name = cursor.takeText();
    sections_[name] = cursor.takeText();
  }
}

void StateArchive::section(const std::string& name)
{
  closeSection();
  const auto found = sections_.find(name);
  if (reading_ && found == sections_.end())
  {
    throw Error("has no section '" + name + "'");
  }
  if (!reading_ && found != sections_.end())
  {
    throw Error("state: section '" + name + "' is written twice");
  }
  name_ = name;
  section_ = &sections_[name];
  at_ = 0;
  ++opened_;
}

void StateArchive::value(bool& what)
{
  std::uint8_t byte = what ? 1 : 0;
  value(byte);
  what = byte != 0;
}

void StateArchive::exchange(void* data, std::size_t size)
{
  if (!reading_)
  {
    section_->append(static_cast<const char*>(data), size);
    return;
  }
  checkRoom(size, 1);
  if (size > 0)
  {
    std::memcpy(data, section_->data() + at_, size);
  }
  at_ += size;
}

void StateArchive::checkSize(std::uint64_t found, std::size_t expected) const
{
  if (found != expected)
  {
    throw Error("section '" + name_ + "' has a list of " + std::to_string(found) + ", must be " +
                std::to_string(expected));
  }
}

void StateArchive::checkRoom(std::uint64_t count, std::size_t each) const
{
  if (count > (section_->size() - at_) / each)
  {
    throw Error("section '" + name_ + "' ends too early");
  }
}

void StateArchive::closeSection() const
{
  if (reading_ && section_ != nullptr && at_ != section_->size())
  {
    throw Error("section '" + name_ + "' has " + std::to_string(section_->size() - at_) +
                " bytes too many");
  }
}

std::string StateArchive::bytes()
{
  std::string all = kMagic;
  append(kVersion, all);
  append(owner_, all);
  for (const auto& [name, content] : sections_)
  {
    append(name, all);
    append(content, all);
  }
  append(checksum(all, all.size()), all);
  return all;
}

void StateArchive::finish()
{
  closeSection();
  if (opened_ != sections_.size())
  {
    throw Error("has sections that are not known here");
  }
}

std::string readBytes(const std::string& file)
{
  checkFile(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream.good())
  {
    throw Error(file + ": can't be read");
  }
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void writeBytes(const std::string& file, const std::string& bytes)
{
  checkFile(file);
  const std::string beside = file + ".part";
  std::remove(beside.c_str());  // it may be a pipe, which makes wait
  std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream.good() || std::rename(beside.c_str(), file.c_str()) != 0)
  {
    std::remove(beside.c_str());
    throw Error(file + ": can't be written");
  }
}

}  // namespace soft_tissue
