#include "soft_tissue_sim/node/transform_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace soft_tissue_sim
{
namespace
{
geometry_msgs::TransformStamped good()
{
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.child_frame_id = "base";
  transform.transform.rotation.w = 1.0;
  return transform;
}

TEST(TransformCheck, takesWhatTfTakes)
{
  EXPECT_EQ(transformRefusal(good()), "");
}

TEST(TransformCheck, saysWhatIsWrong)
{
  auto nameless = good(), loop = good(), infinite = good(), scaled = good(), endless = good();
  nameless.child_frame_id = "";
  loop.child_frame_id = "world";
  infinite.transform.translation.y = INFINITY;
  scaled.transform.rotation.w = 1.1;
  endless.header.stamp.sec = 4000000000u;
  EXPECT_EQ(transformRefusal(nameless), "a frame has no name");
  EXPECT_EQ(transformRefusal(loop), "a frame in itself");
  EXPECT_EQ(transformRefusal(infinite), "not finite");
  EXPECT_EQ(transformRefusal(scaled), "quaternion not unit");
  EXPECT_EQ(transformRefusal(endless), "its stamp is beyond the end of time");
}

}  // namespace
}  // namespace soft_tissue_sim
