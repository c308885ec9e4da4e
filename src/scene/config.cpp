#include "soft_tissue_sim/scene/config.h"

#include "schema_sections.h"

namespace soft_tissue
{
Pose PoseConfig::toPose() const
{
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(rotation_rpy_rad.z(), Vec3::UnitZ()) *
                   Eigen::AngleAxisd(rotation_rpy_rad.y(), Vec3::UnitY()) *
                   Eigen::AngleAxisd(rotation_rpy_rad.x(), Vec3::UnitX()))
                      .toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

SceneConfig loadSceneConfig(const std::string& path, PackageResolver resolver)
{
  const Document document = readDocument(path, resolver);
  SceneConfig config = sceneSection().read(Item(document));
  config.file = path;
  return config;
}

}  // namespace soft_tissue
