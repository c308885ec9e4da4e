#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
geometry_msgs::Point pointMessage(const soft_tissue::Vec3& p);
geometry_msgs::Vector3 vectorMessage(const soft_tissue::Vec3& v);
geometry_msgs::Pose poseMessage(const soft_tissue::Pose& X);
geometry_msgs::Transform transformMessage(const soft_tissue::Pose& X);

soft_tissue::Vec3 vectorFromMessage(const geometry_msgs::Vector3& v);
/** Rigid transform of a message; the quaternion is normalised. */
soft_tissue::Pose poseFromMessage(const geometry_msgs::Pose& pose);
soft_tissue::Pose poseFromMessage(const geometry_msgs::Transform& transform);

/** Force and moment about the tool frame's origin, in world axes. */
geometry_msgs::Wrench spatialWrench(const soft_tissue::Wrench& wrench_W);

/** The same force and moment about the same point, in the tool frame's axes. */
geometry_msgs::Wrench bodyWrench(const soft_tissue::Wrench& wrench_W,
                                 const soft_tissue::Pose& X_WT);

}  // namespace soft_tissue_sim
