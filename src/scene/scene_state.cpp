#include <algorithm>

#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
void add(const Points& points, StateHash& hash)
{
  hash.add(points.data(), points.size() * sizeof(Vec3));
}

void add(const std::string& name, StateHash& hash)
{
  hash.addValue(name.size());
  hash.add(name.data(), name.size());
}

void add(const PoseSeries& track, StateHash& hash)
{
  hash.add(track.times_s.data(), track.times_s.size() * sizeof(double));
  for (const Pose& pose : track.samples)
  {
    hash.add(pose.data(), 16 * sizeof(double));
  }
}

void add(const JointSeries& track, StateHash& hash)
{
  hash.add(track.times_s.data(), track.times_s.size() * sizeof(double));
  for (const JointValues& values : track.samples)
  {
    hash.add(values.data(), values.size() * sizeof(double));
  }
}

/** As many as there are. */
void exchangeValues(StateArchive& archive, JointValues& values)
{
  for (double& value : values)
  {
    archive.value(value);
  }
}
}  // namespace

/** What tells scenes apart whose states can't stand for each other's: bodies, their places among
 * each other, and how steps are taken; not what may change at run time. */
std::uint64_t Scene::Impl::identity() const
{
  StateHash hash;
  hash.addValue(config_.time_step_s);
  hash.addValue(config_.solver.stepper);
  hash.addValue(config_.solver.tolerance);
  hash.addValue(config_.solver.max_iterations);
  hash.addValue(config_.solver.linear);
  hash.addValue(config_.solver.sleep.has_value());
  hash.add(config_.gravity_m_per_s2.data(), sizeof(Vec3));
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const TissueInfo& info = tissue_info_[k];
    add(info.name, hash);
    add(info.rest.nodes, hash);
    hash.add(info.rest.tets.data(), info.rest.tets.size() * sizeof(Tet));
    hash.add(info.surface.triangles.data(), info.surface.triangles.size() * sizeof(Triangle));
    hash.add(info.fixed_nodes.data(), info.fixed_nodes.size() * sizeof(Index));
    const MaterialConfig& material = config_.softBody(k).material;
    hash.addValue(material.model);
    hash.addValue(material.mass_damping_per_s);
    hash.addValue(material.stiffness_damping_s);
    for (const RelaxationBranch& branch : material.relaxation)
    {
      hash.addValue(branch.relative_modulus);
      hash.addValue(branch.relaxation_time);
    }
    if (k < config_.tissues.size())
    {
      hash.addValue(config_.tissues[k].element);
      for (const RegionConfig& region : config_.tissues[k].regions)
      {
        hash.addValue(region.tag);
        hash.addValue(region.model.value_or(material.model));
      }
      add(config_.tissues[k].field.method, hash);
      hash.addValue(config_.tissues[k].field.depth);
      hash.addValue(config_.tissues[k].field.refresh);
    }
  }
  for (const MovedNodes& moved : moved_)
  {
    hash.add(moved.rows.data(), moved.rows.size() * sizeof(Index));
    add(moved.track, hash);
  }
  for (std::size_t k = 0; k < tools_.size(); ++k)
  {
    add(tool_info_[k].name, hash);
    for (const ToolPartInfo& part : tool_info_[k].parts)
    {
      hash.addValue(part.link);
      add(part.surface.nodes, hash);
    }
    for (const Coordinate& joint : tool_info_[k].joints)
    {
      add(joint.name, hash);
    }
    add(tools_[k].track, hash);
    add(tools_[k].joint_track, hash);
  }
  for (const ObstacleInfo& obstacle : obstacle_info_)
  {
    add(obstacle.name, hash);
    hash.addValue(obstacle.cell_size_m);
  }
  for (const ContactConfig& contact : config_.contacts)
  {
    add(contact.tissue, hash);
    add(contact.other, hash);
    hash.addValue(contact.response);
    hash.addValue(contact.law);
    hash.addValue(contact.friction);
    hash.addValue(contact.damping_s_per_m);
    hash.addValue(contact.max_penetration_m.value_or(0.0));
    hash.addValue(contact.stiffness_pa_per_m.value_or(0.0));
    hash.addValue(contact.penalty.value_or(0.0));
  }
  return hash.value();
}

/** Writes the state, or goes on from one that is read. Who has more to remember adds a section. */
void Scene::Impl::exchange(StateArchive& archive)
{
  archive.section("materials");
  exchangeMaterials(archive);
  archive.section("sleep");
  archive.values(asleep_);
  archive.values(quiet_s_);
  archive.values(island_);
  if (archive.reading())
  {
    setSleepers();  // a new solver among others
  }
  archive.section("nodes");
  archive.values(x_);
  archive.values(v_);
  archive.values(acceleration_);
  archive.section("stepper");
  exchangeStepper(archive);
  archive.section("tissues");
  exchangeTissues(archive);
  archive.section("tools");
  exchangeTools(archive);
  archive.section("attachments");
  exchangeAttachments(archive);
  archive.section("obstacles");
  exchangeObstacles(archive);
  archive.section("contacts");
  exchangeContacts(archive);
  archive.section("solver");
  newton_->exchange(archive, allTerms());
  archive.section("report");
  exchangeReport(archive);
  if (archive.reading())
  {
    archive.finish();
    collectContacts();
  }
}

void Scene::Impl::exchangeStepper(StateArchive& archive)
{
  archive.values(x_last_);
  archive.values(v_last_);
  archive.values(smooth_);
  archive.values(formula_);
  archive.value(last_h_);
  archive.value(was_held_);
  if (!archive.reading())
  {
    return;
  }
  // Whether the matrix serves on is a matter of whether these change.
  before_ = x_;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (formula_[k].effective_s > 0.0)
    {
      inertia_->beginStep(tissues_[k].first_node, tissues_[k].node_count, startOfPart(),
                          formula_[k]);
    }
  }
}

void Scene::Impl::exchangeTissues(StateArchive& archive)
{
  for (Tissue& tissue : tissues_)
  {
    archive.value(tissue.min_det_f);
    archive.value(tissue.evaluations);
    if (tissue.tets != nullptr)
    {
      tissue.tets->exchange(archive);
    }
  }
}

void Scene::Impl::exchangeTools(StateArchive& archive)
{
  for (Tool& tool : tools_)
  {
    for (Pose* pose : {&tool.X_WT, &tool.X_WT_goal, &tool.X_WT_target})
    {
      archive.value(*pose);
    }
    for (JointValues* values : {&tool.joints, &tool.joints_goal, &tool.joints_target})
    {
      exchangeValues(archive, *values);
    }
    tool.state.X_WT = tool.X_WT;
    tool.state.joints = tool.joints;
    for (std::size_t k = 0; k < tool.parts.size(); ++k)
    {
      archive.value(tool.parts[k].X_WP);
      archive.value(tool.parts[k].X_WP_goal);
      tool.state.parts[k].X_WP = tool.parts[k].X_WP;
    }
  }
}

void Scene::Impl::exchangeAttachments(StateArchive& archive)
{
  std::uint64_t count = attachments_.size();
  archive.value(count);
  if (count > x_.size() * tools_.size())
  {
    throw Error("ties more nodes than there are");
  }
  attachments_.resize(count);
  for (Attachment& one : attachments_)
  {
    for (std::size_t* number : {&one.tool, &one.part, &one.tissue})
    {
      archive.value(*number);
    }
    archive.value(one.row);
    archive.value(one.place_P);
    archive.value(one.stiffness);
    const bool known = one.tool < tools_.size() && one.part < tools_[one.tool].parts.size() &&
                       one.tissue < tissues_.size() && one.row >= 0 &&
                       one.row < static_cast<Index>(x_.size());
    if (!known)
    {
      throw Error("ties what is not in the scene");
    }
  }
  countAttachments();
}

void Scene::Impl::exchangeObstacles(StateArchive& archive)
{
  for (Obstacle& obstacle : obstacles_)
  {
    archive.value(obstacle.X_WO);
    VoxelSet cells = obstacle.shape->cells();
    if (obstacle.changes)
    {
      cells.exchange(archive);
    }
    CellBox covered = obstacle.shape->coveredPatches();
    for (Cell* corner : {&covered.low, &covered.high})
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        archive.value((*corner)[axis]);
      }
    }
    if (archive.reading())
    {
      obstacle.shape->remake(std::move(cells), covered);
      obstacle.shown = Box3();
    }
  }
}

void Scene::Impl::exchangeContacts(StateArchive& archive)
{
  for (Contact& contact : contacts_)
  {
    archive.value(contact.allowance_m);
    archive.list(contact.last_force);
    if (archive.reading() && contact.with_tissue != nullptr)
    {
      allow(contact.allowance_m, contact);
    }
    if (archive.reading() && contact.with_obstacle != nullptr)
    {
      contact.with_obstacle->setPose(obstacles_[contact.other].X_WO);
    }
    contact.term->exchange(archive, x_);
  }
}

/** All terms there may be, in an order that stays. */
std::vector<EnergyTerm*> Scene::Impl::allTerms()
{
  std::vector<EnergyTerm*> terms = {gravity_.get(), inertia_.get()};
  if (drag_ != nullptr)
  {
    terms.push_back(drag_.get());
  }
  for (const Tissue& tissue : tissues_)
  {
    if (tissue.tets != nullptr)
    {
      tissue.tets->addTerms(terms);
    }
    else
    {
      terms.push_back(tissue.membrane.get());
    }
  }
  for (const Contact& contact : contacts_)
  {
    terms.push_back(contact.term.get());
  }
  terms.push_back(&anchors_);
  return terms;
}

/** What it says of the contacts is found anew. */
void Scene::Impl::exchangeReport(StateArchive& archive)
{
  archive.value(report_.step);
  archive.value(report_.time_s);
  archive.value(report_.newton_iterations);
  archive.value(report_.linear_iterations);
  archive.value(report_.residual);
  archive.value(report_.converged);
  archive.value(report_.out_of_time);
  archive.value(report_.position_error_m);
  archive.value(report_.parts);
  archive.value(report_.halvings);
  archive.value(report_.held);
  archive.value(report_.min_det_f);
  archive.value(report_.sleeping);
  if (archive.reading())
  {
    report_.max_penetration_m = 0.0;
    report_.contacts = 0;
    report_.ms = StageTimes();
  }
}

std::string Scene::Impl::stateBytes()
{
  StateArchive archive(identity());
  exchange(archive);
  return archive.bytes();
}

void Scene::saveState(const std::string& file) const
{
  writeBytes(file, impl_->stateBytes());
}

void Scene::loadState(const std::string& file)
{
  const std::string bytes = readBytes(file);
  const std::string before = impl_->stateBytes();
  try
  {
    StateArchive archive(bytes, impl_->identity());
    impl_->exchange(archive);
  }
  catch (const Error& error)
  {
    StateArchive archive(before, impl_->identity());
    impl_->exchange(archive);
    throw Error("state " + file + " " + error.what());
  }
}

}  // namespace soft_tissue
