#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "soft_tissue_sim/geometry/linkage.h"
#include "soft_tissue_sim/scene/pose_config.h"

namespace soft_tissue
{
struct SphereShape
{
  double radius_m = 0.0;
};

/** Segment of this length along z, centred at the origin, swept by a ball. */
struct CapsuleShape
{
  double radius_m = 0.0;
  double length_m = 0.0;
};

struct BoxShape
{
  Vec3 size_m = Vec3::Zero();  ///< full edge lengths
};

/** A closed triangle mesh, given in the shape frame. */
struct MeshShape
{
  MeshConfig mesh;
  Vec3 scale = Vec3::Ones();
};

using ShapeGeometry = std::variant<SphereShape, CapsuleShape, BoxShape, MeshShape>;

/** One solid of a tool, placed on a link of its linkage. */
struct ShapeConfig
{
  ShapeGeometry geometry;
  PoseConfig origin;     ///< pose of the shape frame in the link's frame
  std::size_t link = 0;  ///< of ToolConfig::linkage
};

/** How a link looks where that is not its shape; means nothing to the physics. */
struct VisualConfig
{
  enum class Kind
  {
    sphere,
    box,
    cylinder,  ///< along z
    mesh,
  };
  Kind kind = Kind::mesh;
  Vec3 size = Vec3::Ones();  ///< edge lengths of the box around it, m; of a mesh its scale
  std::string mesh_uri;      ///< package:// or file://
  PoseConfig origin;         ///< in the link's frame
  std::size_t link = 0;
  std::optional<std::array<double, 4>> colour_rgba;
};

/** Tool geometry taken from links of a URDF; the node layer turns it into shapes on a linkage. */
struct UrdfShapeConfig
{
  std::string file;  ///< absolute path
  std::vector<std::string> links;
  std::string frame = "";  ///< link whose frame is the tool's; empty: the first of `links`
};

struct PoseSourceConfig
{
  enum class Kind
  {
    keyframes,
    topic,
    twist,
    tf,
    marker,
    base,
  };
  Kind kind = Kind::topic;
  std::vector<PoseKeyframe> keyframes;  ///< ascending times; linear / slerp between, held outside
  std::string name = "servo_cp";        ///< topic below the tool's namespace, or tf frame
  PoseConfig base_pose;  ///< where the root of the URDF stands, whose joints move the tool frame
};

struct JointValue
{
  std::string joint;
  double value = 0.0;  ///< rad or m
};

struct JointKeyframe
{
  double time_s = 0.0;
  std::vector<JointValue> values;
};

struct JointSourceConfig
{
  enum class Kind
  {
    keyframes,
    topic,
    tf,
  };
  Kind kind = Kind::topic;
  /** Ascending times; linear between, held outside. A joint is given in all of them or in none. */
  std::vector<JointKeyframe> keyframes;
  std::string name = "joint_states";  ///< topic below the tool's namespace, or prefix of tf frames
};

/** A joint that opens or closes a jaw. */
struct JawJoint
{
  std::string joint;
  double share = 1.0;  ///< its value over the jaw's
};

struct JawConfig
{
  std::vector<JawJoint> joints;
  std::string topic = "jaw/servo_jp";  ///< below the tool's namespace
};

struct ToolConfig
{
  std::string name;
  std::vector<ShapeConfig> shapes;
  std::optional<UrdfShapeConfig> urdf;
  Linkage linkage;        ///< what the shapes are on: of a URDF once it is read, else one link
  std::size_t frame = 0;  ///< the link whose frame is the tool's
  std::vector<VisualConfig> visuals;
  std::vector<std::string> remarks;  ///< what reading the URDF left out
  PoseConfig initial_pose;  ///< where the tool waits for its first command; key frames override it
  PoseSourceConfig pose_source;
  std::vector<JointValue> initial_joints;  ///< others are as near to zero as their limits allow
  JointSourceConfig joint_source;
  std::optional<JawConfig> jaw;
  std::optional<double> max_speed_m_per_s;  ///< of the tool frame; key frames may be faster
  std::optional<double> max_turn_rate_rad_per_s;
};

}  // namespace soft_tissue
