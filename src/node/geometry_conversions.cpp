#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
template <typename Message>
Message xyzMessage(const soft_tissue::Vec3& v)
{
  Message message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Quaternion quaternionMessage(const soft_tissue::Mat3& rotation)
{
  const Eigen::Quaterniond q(rotation);
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

template <typename Position>
soft_tissue::Pose poseFromParts(const Position& position, const geometry_msgs::Quaternion& rotation)
{
  const Eigen::Quaterniond q(rotation.w, rotation.x, rotation.y, rotation.z);
  soft_tissue::Pose X = soft_tissue::Pose::Identity();
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() << position.x, position.y, position.z;
  return X;
}

}  // namespace

geometry_msgs::Point pointMessage(const soft_tissue::Vec3& p)
{
  return xyzMessage<geometry_msgs::Point>(p);
}

geometry_msgs::Vector3 vectorMessage(const soft_tissue::Vec3& v)
{
  return xyzMessage<geometry_msgs::Vector3>(v);
}

geometry_msgs::Pose poseMessage(const soft_tissue::Pose& X)
{
  geometry_msgs::Pose message;
  message.position = pointMessage(X.translation());
  message.orientation = quaternionMessage(X.linear());
  return message;
}

geometry_msgs::Transform transformMessage(const soft_tissue::Pose& X)
{
  geometry_msgs::Transform message;
  message.translation = vectorMessage(X.translation());
  message.rotation = quaternionMessage(X.linear());
  return message;
}

soft_tissue::Vec3 vectorFromMessage(const geometry_msgs::Vector3& v)
{
  return {v.x, v.y, v.z};
}

soft_tissue::Pose poseFromMessage(const geometry_msgs::Pose& pose)
{
  return poseFromParts(pose.position, pose.orientation);
}

soft_tissue::Pose poseFromMessage(const geometry_msgs::Transform& transform)
{
  return poseFromParts(transform.translation, transform.rotation);
}

geometry_msgs::Wrench spatialWrench(const soft_tissue::Wrench& wrench_W)
{
  geometry_msgs::Wrench message;
  message.force = vectorMessage(wrench_W.force);
  message.torque = vectorMessage(wrench_W.torque);
  return message;
}

geometry_msgs::Wrench bodyWrench(const soft_tissue::Wrench& wrench_W, const soft_tissue::Pose& X_WT)
{
  const soft_tissue::Mat3 R_TW = X_WT.linear().transpose();
  geometry_msgs::Wrench message;
  message.force = vectorMessage(R_TW * wrench_W.force);
  message.torque = vectorMessage(R_TW * wrench_W.torque);
  return message;
}

}  // namespace soft_tissue_sim
