#include <gtest/gtest.h>
#include <ros/header.h>

#include <boost/shared_array.hpp>
#include <cstring>
#include <string>
#include <vector>

namespace soft_tissue_sim
{
namespace
{
std::string field(std::uint32_t length, const std::string& text)
{
  return std::string(reinterpret_cast<const char*>(&length), sizeof(length)) + text;
}

std::string field(const std::string& text)
{
  return field(static_cast<std::uint32_t>(text.size()), text);
}

/** Of exactly the bytes there are. @return why a header is refused; empty: it isn't */
std::string refusal(const std::string& bytes, ros::M_string* fields = nullptr)
{
  const boost::shared_array<std::uint8_t> exact(new std::uint8_t[bytes.size()]);
  std::memcpy(exact.get(), bytes.data(), bytes.size());
  ros::Header header;
  std::string error;
  const bool read = header.parse(exact, static_cast<std::uint32_t>(bytes.size()), error);
  EXPECT_EQ(read, error.empty()) << error;
  if (fields != nullptr)
  {
    *fields = *header.getValues();
  }
  return error;
}

TEST(ConnectionHeader, hasTheFieldsThatWereWritten)
{
  const ros::M_string written = {
      {"topic", "/a=b"}, {"type", ""}, {"callerid", std::string("\0", 1)}};
  boost::shared_array<std::uint8_t> buffer;
  std::uint32_t size = 0;
  ros::Header::write(written, buffer, size);
  ros::M_string fields;
  EXPECT_EQ(refusal(std::string(buffer.get(), buffer.get() + size), &fields), "");
  EXPECT_EQ(fields, written);
  EXPECT_EQ(refusal("", &fields), "");
  EXPECT_TRUE(fields.empty());
}

TEST(ConnectionHeader, isNotReadBehindItsEnd)
{
  const std::string good = field("topic=/a");
  for (std::size_t size = 1; size < good.size(); ++size)
  {
    EXPECT_NE(refusal(good.substr(0, size)), "") << size;
    EXPECT_NE(refusal(good + good.substr(0, size)), "") << size;
  }
  for (const std::uint32_t length : {9u, 4102u, 1000000u, 1000001u, 4294967295u})
  {
    EXPECT_EQ(
        refusal(field(length, "topic=/a")),
        "a field of the header claims " + std::to_string(length) + " bytes, of which 8 are there");
  }
  EXPECT_EQ(refusal(field("topic")), "a field of the header has no '='");
}

}  // namespace
}  // namespace soft_tissue_sim
