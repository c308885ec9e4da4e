#include "soft_tissue_sim/node/message_builders.h"

#include "soft_tissue_sim/node/geometry_conversions.h"
#include "soft_tissue_sim/node/joint_inputs.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Snapshot;
using soft_tissue::ToolState;
using soft_tissue::Vec3;

void setHeader(std_msgs::Header& header, const Stamp& stamp)
{
  header.stamp = stamp.time;
  header.frame_id = stamp.world_frame;
}

void appendFlat(std::vector<float>& flat, const soft_tissue::Points& points)
{
  flat.reserve(flat.size() + 3 * points.size());
  for (const Vec3& p : points)
  {
    flat.insert(flat.end(),
                {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
}

template <typename Tuples>
std::vector<std::uint32_t> flatIndices(const Tuples& tuples)
{
  std::vector<std::uint32_t> flat;
  for (const auto& tuple : tuples)
  {
    flat.insert(flat.end(), tuple.begin(), tuple.end());
  }
  return flat;
}

/** What messages of tools and of tissues have in common. */
template <typename Contacts>
void appendContact(const soft_tissue::ContactPoint& contact, Contacts& message)
{
  const double normal_force = contact.force_W.dot(contact.normal_W);
  message.tets.push_back(contact.tet);
  message.points.push_back(pointMessage(contact.position_W));
  message.normals.push_back(vectorMessage(contact.normal_W));
  message.depths.push_back(contact.depth);
  message.areas.push_back(contact.area);
  message.pressures.push_back(contact.area > 0.0 ? normal_force / contact.area : 0.0);
  message.forces.push_back(vectorMessage(contact.force_W));
}

}  // namespace

TissueMesh meshMessage(const SceneInfo& info, std::size_t tissue, const Stamp& stamp)
{
  const soft_tissue::TissueInfo& source = info.tissues[tissue];
  TissueMesh message;
  setHeader(message.header, stamp);
  message.name = source.name;
  message.topology_id = info.topology_ids[tissue];
  appendFlat(message.rest_positions, source.rest.nodes);
  message.tets = flatIndices(source.rest.tets);
  message.triangles = flatIndices(source.surface.triangles);
  message.fixed_nodes.assign(source.fixed_nodes.begin(), source.fixed_nodes.end());
  message.region_tags.assign(source.rest.tags.begin(), source.rest.tags.end());
  return message;
}

TissueState stateMessage(const SceneInfo& info, const Snapshot& snapshot, std::size_t tissue,
                         const Stamp& stamp)
{
  TissueState message;
  setHeader(message.header, stamp);
  message.name = info.tissue_names[tissue];
  message.topology_id = info.topology_ids[tissue];
  message.step = snapshot.report.step;
  message.state_hash = snapshot.state_hash;
  appendFlat(message.positions, snapshot.tissues[tissue].positions);
  message.von_mises = snapshot.tissues[tissue].von_mises;
  return message;
}

TissueField fieldMessage(const SceneInfo& info, std::size_t tissue, std::uint64_t step,
                         const std::vector<double>& depth, const Stamp& stamp)
{
  TissueField message;
  setHeader(message.header, stamp);
  message.name = info.tissue_names[tissue];
  message.topology_id = info.topology_ids[tissue];
  message.step = step;
  message.depths.assign(depth.begin(), depth.end());
  return message;
}

geometry_msgs::PoseStamped toolPoseMessage(const ToolState& tool, const Stamp& stamp)
{
  geometry_msgs::PoseStamped message;
  setHeader(message.header, stamp);
  message.pose = poseMessage(tool.X_WT);
  return message;
}

sensor_msgs::JointState jointMessage(const soft_tissue::ToolInfo& info, const ToolState& tool,
                                     const Stamp& stamp)
{
  sensor_msgs::JointState message;
  message.header.stamp = stamp.time;
  for (const soft_tissue::Coordinate& joint : info.joints)
  {
    message.name.push_back(joint.name);
  }
  message.position.assign(tool.joints.data(), tool.joints.data() + tool.joints.size());
  return message;
}

sensor_msgs::JointState jawMessage(const soft_tissue::ToolConfig& config, const ToolState& tool,
                                   const Stamp& stamp)
{
  sensor_msgs::JointState message;
  message.header.stamp = stamp.time;
  message.name = {"jaw"};
  message.position = {jawPosition(config, tool.joints)};
  return message;
}

geometry_msgs::WrenchStamped bodyWrenchMessage(const ToolState& tool, const std::string& tool_name,
                                               const Stamp& stamp)
{
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp.time;
  message.header.frame_id = tool_name;
  message.wrench = bodyWrench(tool.wrench_W, tool.X_WT);
  return message;
}

geometry_msgs::WrenchStamped spatialWrenchMessage(const ToolState& tool, const Stamp& stamp)
{
  geometry_msgs::WrenchStamped message;
  setHeader(message.header, stamp);
  message.wrench = spatialWrench(tool.wrench_W);
  return message;
}

ToolContacts contactsMessage(const SceneInfo& info, const Snapshot& snapshot, std::size_t tool,
                             const Stamp& stamp)
{
  ToolContacts message;
  setHeader(message.header, stamp);
  message.name = info.tools[tool].name;
  message.tissue_names = info.tissue_names;
  for (const soft_tissue::ToolPartInfo& part : info.tools[tool].parts)
  {
    message.part_names.push_back(part.name);
  }
  for (const soft_tissue::ContactPoint& contact : snapshot.tools[tool].contacts)
  {
    message.parts.push_back(static_cast<std::uint32_t>(contact.part));
    message.tissues.push_back(static_cast<std::uint32_t>(contact.tissue));
    appendContact(contact, message);
  }
  return message;
}

TissueContacts tissueContactsMessage(const SceneInfo& info, const Snapshot& snapshot,
                                     const Stamp& stamp)
{
  TissueContacts message;
  setHeader(message.header, stamp);
  message.tissue_names = info.tissue_names;
  for (const soft_tissue::TissuePairState& pair : snapshot.tissue_pairs)
  {
    for (const soft_tissue::ContactPoint& contact : pair.contacts)
    {
      message.firsts.push_back(static_cast<std::uint32_t>(pair.first));
      message.seconds.push_back(static_cast<std::uint32_t>(pair.second));
      message.hosts.push_back(static_cast<std::uint32_t>(contact.tissue));
      appendContact(contact, message);
    }
  }
  return message;
}

SimStats statsMessage(const Snapshot& snapshot, double real_time_factor, const Stamp& stamp)
{
  const soft_tissue::StepReport& report = snapshot.report;
  SimStats message;
  setHeader(message.header, stamp);
  message.step = report.step;
  message.sim_time = report.time_s;
  message.real_time_factor = real_time_factor;
  message.step_ms = report.ms.total;
  message.stage_names = {"fem", "field", "detect", "respond", "solve"};
  message.stage_ms = {report.ms.fem, report.ms.field, report.ms.detect, report.ms.respond,
                      report.ms.solve};
  message.newton_iterations = static_cast<std::uint32_t>(report.newton_iterations);
  message.linear_iterations = static_cast<std::uint32_t>(report.linear_iterations);
  message.residual = report.residual;
  message.converged = report.converged;
  message.out_of_time = report.out_of_time;
  message.position_error = report.position_error_m;
  message.parts = static_cast<std::uint32_t>(report.parts);
  message.halvings = static_cast<std::uint32_t>(report.halvings);
  message.held = report.held;
  message.min_det_f = report.min_det_f;
  message.max_penetration = report.max_penetration_m;
  message.contacts = static_cast<std::uint32_t>(report.contacts);
  message.sleeping = static_cast<std::uint32_t>(report.sleeping);
  message.state_hash = snapshot.state_hash;
  return message;
}

}  // namespace soft_tissue_sim
