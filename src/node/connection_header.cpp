#include <ros/header.h>

#include <algorithm>
#include <cstring>

// Stands in front of the definitions in libcpp_common, for this library comes before it in every
// program's list: those read on behind the end of a header, of a connection or in a bag, whose
// fields claim more than it has, and any connection can end the process with that.
// Source: https://wiki.ros.org/ROS/Connection%20Header
namespace ros
{
bool Header::parse(const boost::shared_array<uint8_t>& buffer, uint32_t size, std::string& error)
{
  return parse(buffer.get(), size, error);
}

bool Header::parse(uint8_t* buffer, uint32_t size, std::string& error)
{
  const uint8_t* at = buffer;
  const uint8_t* const end = buffer + size;
  while (at != end)
  {
    uint32_t length = 0;
    if (static_cast<std::size_t>(end - at) < sizeof(length))
    {
      error = "the header ends within the length of a field";
      return false;
    }
    std::memcpy(&length, at, sizeof(length));
    at += sizeof(length);
    if (length > static_cast<std::size_t>(end - at))
    {
      error = "a field of the header claims " + std::to_string(length) + " bytes, of which " +
              std::to_string(end - at) + " are there";
      return false;
    }
    const uint8_t* const next = at + length;
    const uint8_t* const equals = std::find(at, next, '=');
    if (equals == next)
    {
      error = "a field of the header has no '='";
      return false;
    }
    (*read_map_)[std::string(at, equals)] = std::string(equals + 1, next);
    at = next;
  }
  return true;
}

}  // namespace ros
