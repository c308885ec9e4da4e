#include "schema_sections.h"

namespace soft_tissue
{
Kind<double> lengthUnit()
{
  return choice<double>({{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}});
}

Kind<Vec3> position()
{
  return vector(1000.0);
}

/** At most one turn either way: degrees given by mistake are found out. */
Kind<Vec3> rotation()
{
  return vector(6.2832);
}

Kind<double> shapeLength()
{
  return number(0.0, 10.0, Ends::open);
}

const Section<PoseConfig>& poseSection()
{
  static const Section<PoseConfig> section =
      Section<PoseConfig>("pose", "Where a frame stands in the frame above it.")
          .optional("position_m", &PoseConfig::position_m, position(), "Origin.")
          .optional("rotation_rpy_rad", &PoseConfig::rotation_rpy_rad, rotation(),
                    "Roll, pitch, yaw about fixed axes x, y, z, in this order, as in URDF.");
  return section;
}

}  // namespace soft_tissue
