#include "soft_tissue_sim/base/state_archive.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/hash.h"
#include "support/mesh_file_content.h"

namespace soft_tissue::test
{
namespace
{
constexpr std::uint64_t kOwner = 7;

struct Things
{
  double number = 0.1;
  bool flag = true;
  Vec3 place = Vec3(1.0, -0.0, 3.0);
  std::vector<int> two = {1, 2};
  Points any = {Vec3(1.0 / 3.0, 0.0, 0.0)};

  void exchange(StateArchive& archive)
  {
    archive.section("first");
    archive.value(number);
    archive.value(flag);
    archive.value(place);
    archive.section("second");
    archive.values(two);
    archive.list(any);
  }
};

std::string written()
{
  StateArchive archive(kOwner);
  Things().exchange(archive);
  return archive.bytes();
}

/** What reading these bytes complains of. */
std::string complaint(const std::string& bytes, std::uint64_t owner = kOwner)
{
  try
  {
    StateArchive archive(bytes, owner);
    Things().exchange(archive);
    archive.finish();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "none";
}

template <typename Exchange>
std::string writtenBy(const Exchange& exchange)
{
  StateArchive archive(kOwner);
  exchange(archive);
  return archive.bytes();
}

TEST(StateArchive, GivesBackWhatItTook)
{
  Things things = {-0.0, false, Vec3::Zero(), {3, 4}, {}};
  StateArchive archive(written(), kOwner);
  things.exchange(archive);
  archive.finish();
  const Things expected;
  EXPECT_EQ(things.number, expected.number);
  EXPECT_EQ(things.flag, expected.flag);
  EXPECT_EQ(things.place, expected.place);
  EXPECT_TRUE(std::signbit(things.place.y()));
  EXPECT_EQ(things.two, expected.two);
  EXPECT_EQ(things.any, expected.any);
  EXPECT_EQ(written(), written()) << "the same state, the same bytes";
}

TEST(StateArchive, RefusesWhatIsNotItsOwn)
{
  const std::string good = written();
  EXPECT_EQ(complaint(good), "none");
  EXPECT_EQ(complaint(""), "is no saved state");
  EXPECT_EQ(complaint("time_step_s: 0.01"), "is no saved state");
  EXPECT_EQ(complaint(good, 8), "is the state of another scene");
  EXPECT_EQ(complaint(writtenBy([](StateArchive& archive) { archive.section("first"); })),
            "section 'first' ends too early");
  EXPECT_EQ(complaint(writtenBy([](StateArchive& archive) {
              Things things;
              things.two.push_back(3);
              things.exchange(archive);
            })),
            "section 'second' has a list of 3, must be 2");
  EXPECT_EQ(complaint(writtenBy([](StateArchive& archive) {
              Things().exchange(archive);
              int more = 1;
              archive.value(more);
            })),
            "section 'second' has 4 bytes too many");
  EXPECT_EQ(complaint(writtenBy([](StateArchive& archive) {
              Things().exchange(archive);
              archive.section("third");
            })),
            "has sections that are not known here");
  EXPECT_EQ(complaint(writtenBy([](StateArchive&) {})), "has no section 'first'");
}

// Of every byte, and of every length.
TEST(StateArchive, RefusesWhatIsDamaged)
{
  const std::string good = written();
  for (std::size_t i = 0; i < good.size(); ++i)
  {
    for (const int bit : {0, 3, 7})
    {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ 1 << bit);
      EXPECT_NE(complaint(bad), "none") << i;
    }
    EXPECT_NE(complaint(good.substr(0, i)), "none") << i;
  }
  EXPECT_NE(complaint(good + 'x'), "none");
}

TEST(StateArchive, TellsOtherVersionsApart)
{
  // The version stands behind the first line; the checksum is made anew as a later one would.
  std::string later = written();
  const std::size_t at = later.find('\n') + 1;
  later[at] = 2;
  later.resize(later.size() - 8);
  StateHash hash;
  hash.add(later.data(), later.size());
  const std::uint64_t sum = hash.value();
  later.append(reinterpret_cast<const char*>(&sum), 8);
  EXPECT_EQ(complaint(later), "has format version 2, must be 1");
}

template <typename Act>
std::string complaintOf(const Act& act)
{
  try
  {
    act();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "none";
}

TEST(StateArchive, FilesComeWholeOrNotAtAll)
{
  const ScratchFolder folder;
  const std::string file = folder.path("state");
  writeBytes(file, "abc");
  writeBytes(file, std::string("d\0f", 3));
  EXPECT_EQ(readBytes(file), std::string("d\0f", 3));
  const std::string nowhere = folder.path("gone") + "/state";
  EXPECT_EQ(complaintOf([&] { writeBytes(nowhere, "abc"); }), nowhere + ": can't be written");
  EXPECT_EQ(complaintOf([&] { readBytes(nowhere); }), nowhere + ": can't be read");
}

TEST(StateArchive, WhatIsNoFileIsNotWaitedFor)
{
  const ScratchFolder folder;
  const std::string file = folder.path("state"), pipe = folder.path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero"), folder.path("")})
  {
    EXPECT_EQ(complaintOf([&] { readBytes(path); }), path + ": is no file");
    EXPECT_EQ(complaintOf([&] { writeBytes(path, "abc"); }), path + ": is no file");
  }
  ASSERT_EQ(mkfifo((file + ".part").c_str(), 0600), 0);
  writeBytes(file, "abc");
  EXPECT_EQ(readBytes(file), "abc");
}

}  // namespace
}  // namespace soft_tissue::test
