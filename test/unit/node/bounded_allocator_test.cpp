#include "soft_tissue_sim/node/bounded_allocator.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <vector>

namespace soft_tissue_sim
{
namespace
{
using Bounded = tf2_msgs::TFMessage_<BoundedAllocator<void>>;

TEST(BoundedAllocator, RefusesMoreThanAQuarterOfAGigabyte)
{
  std::vector<double, BoundedAllocator<double>> numbers;
  numbers.resize(1 << 20);
  EXPECT_EQ(numbers.back(), 0.0);
  EXPECT_THROW(numbers.resize(std::size_t{1} << 26), std::length_error);
}

TEST(BoundedAllocator, MessagesOfItAreTheSameOnTheWire)
{
  EXPECT_STREQ(ros::message_traits::md5sum<Bounded>(),
               ros::message_traits::md5sum<tf2_msgs::TFMessage>());
  EXPECT_STREQ(ros::message_traits::datatype<Bounded>(), "tf2_msgs/TFMessage");
  tf2_msgs::TFMessage sent;
  sent.transforms.resize(2);
  sent.transforms[1].child_frame_id = "tool";
  sent.transforms[1].transform.rotation.w = 0.5;
  ros::SerializedMessage wire = ros::serialization::serializeMessage(sent);
  Bounded received;
  ros::serialization::IStream stream(wire.message_start,
                                     static_cast<std::uint32_t>(wire.num_bytes - 4));
  ros::serialization::deserialize(stream, received);
  ASSERT_EQ(received.transforms.size(), 2u);
  EXPECT_EQ(received.transforms[1].transform.rotation.w, 0.5);
}

TEST(BoundedAllocator, EndsAMessageThatClaimsToBeEndless)
{
  std::vector<std::uint8_t> wire(200, 0);
  std::fill(wire.begin(), wire.begin() + 4, 0xff);  // as many transforms
  Bounded received;
  ros::serialization::IStream stream(wire.data(), static_cast<std::uint32_t>(wire.size()));
  EXPECT_THROW(ros::serialization::deserialize(stream, received), std::exception);
}

}  // namespace
}  // namespace soft_tissue_sim
