#include <algorithm>
#include <limits>

#include "bodies.h"
#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/energy/membrane_elasticity.h"

namespace soft_tissue
{
namespace
{
/** At a tolerance of 1, minimisations end with nodes this share of a tissue's size off. */
constexpr double kSettled = 1e-3;

/** The share of edges that are short, see TissueBody::short_edge. */
constexpr double kShortEdges = 0.1;

/** Length of the smallest tissue, m. */
double smallestSize(const std::vector<TissueInfo>& tissues)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const TissueInfo& tissue : tissues)
  {
    const Box3 box = boundsOf(tissue.rest.nodes);
    smallest = std::min(smallest, (box.max - box.min).maxCoeff());
  }
  return smallest;
}
}  // namespace

Scene::Impl::Impl(const SceneConfig& config) : config_(config)
{
  tissues_.resize(config_.tissues.size() + config_.membranes.size());
  tissue_info_.reserve(tissues_.size());
  group_.resize(tissues_.size());
  held_.resize(tissues_.size());
  goal_.resize(tissues_.size());
  formula_.resize(tissues_.size());
  smooth_.resize(tissues_.size());
  asleep_.resize(tissues_.size());
  quiet_s_.resize(tissues_.size());
  island_.resize(tissues_.size());
  islands_found_.resize(tissues_.size());
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    k < config_.tissues.size() ? addTissue(k) : addMembrane(k);
  }
  x_rest_ = x_;
  v_.resize(x_.size());
  acceleration_.resize(x_.size());
  x_last_ = x_;
  v_last_.assign(x_.size(), Vec3::Zero());
  contact_force_.assign(x_.size(), Vec3::Zero());
  inertia_ = std::make_unique<Inertia>(masses_);
  makeDrag();
  gravity_ = std::make_unique<Gravity>(load_masses_, config_.gravity_m_per_s2);
  makeSolver();
  setOff();
  tools_.reserve(config_.tools.size());
  for (std::size_t k = 0; k < config_.tools.size(); ++k)
  {
    addTool(k);
  }
  for (std::size_t k = 0; k < config_.obstacles.size(); ++k)
  {
    addObstacle(k);
  }
  for (std::size_t k = 0; k < config_.contacts.size(); ++k)
  {
    addContact(k);
  }
  saved_.resize(kMaxHalvings + 1);
  refuseDeepStart();
  findDeepStarts();
  showObstacles();
}

Scene::Impl::Tissue& Scene::Impl::addSoftBody(std::size_t index, const SoftBodyModel& model)
{
  const SoftBodyConfig& config = config_.softBody(index);
  tissue_info_.push_back(model.info);
  tissues_in_file_order_.push_back(inFileOrder(model));
  const TissueInfo& info = tissue_info_.back();
  if (config_.solver.stepper == Stepper::quasi_static && info.fixed_nodes.empty() &&
      model.moved.empty())
  {
    throw Error(itemOf(index) + ".fixed is empty: a quasi-static " +
                (info.isMembrane() ? "membrane" : "tissue") + " needs a fixed region");
  }
  Tissue& tissue = tissues_[index];
  tissue.first_node = static_cast<Index>(x_.size());
  for (std::size_t k = 0; k < model.moved.size(); ++k)
  {
    MovedNodes moved;
    moved.tissue = index;
    moved.rows = model.moved[k];
    for (Index& row : moved.rows)
    {
      row += tissue.first_node;
    }
    const std::vector<PoseKeyframe>& motion = config.keyframes[k].motion;
    moved.X_FW = motion[0].pose.toPose().inverse();
    for (const PoseKeyframe& keyframe : motion)
    {
      moved.track.times_s.push_back(keyframe.time_s);
      moved.track.samples.push_back(keyframe.pose.toPose());
    }
    moved_.push_back(std::move(moved));
  }
  tissue.node_count = static_cast<Index>(info.rest.nodes.size());
  tissue.file_node = model.file_node;
  tissue.short_edge = edgeLength(info, kShortEdges);
  x_.insert(x_.end(), info.rest.nodes.begin(), info.rest.nodes.end());
  masses_.resize(x_.size(), 0.0);
  load_masses_.resize(x_.size(), 0.0);
  return tissue;
}

void Scene::Impl::addTissue(std::size_t index)
{
  const TissueModel model = makeTissue(config_.tissues[index], itemOf(index));
  Tissue& tissue = addSoftBody(index, model);
  tissue.neighbours = elementNeighbours(model);
  const MaterialConfig& material = config_.tissues[index].material;
  tissue.tets = std::make_unique<TissueElasticity>(
      model, ViscosityParameters{material.stiffness_damping_s, material.relaxation},
      tissue.first_node);
  addMasses(model, tissue.first_node, masses_, load_masses_);
}

void Scene::Impl::addMembrane(std::size_t index)
{
  const MembraneConfig& config = config_.membranes[index - config_.tissues.size()];
  Tissue& membrane = addSoftBody(index, makeMembrane(config, itemOf(index)));
  const TissueInfo& info = tissue_info_[index];
  const TriMesh rest = {info.rest.nodes, info.surface.triangles};
  membrane.neighbours = membraneNeighbours(membrane.node_count, rest.triangles);
  const MaterialConfig& material = config.material;
  membrane.membrane = std::make_unique<MembraneElasticity>(
      rest,
      std::vector<MembraneParameters>(
          rest.triangles.size(),
          {material.young_modulus_pa, material.poisson_ratio, config.thickness_m}),
      membrane.first_node);
  const std::vector<double> surface_densities(rest.triangles.size(),
                                              material.density_kg_per_m3 * config.thickness_m);
  for (std::vector<double>* masses : {&masses_, &load_masses_})
  {
    addLumpedMasses(rest, surface_densities, membrane.first_node, *masses);
  }
}

/** Damping in proportion to mass, if a body has any. */
void Scene::Impl::makeDrag()
{
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const double damping = config_.softBody(k).material.mass_damping_per_s;
    if (damping > 0.0)
    {
      drags_.resize(masses_.size(), 0.0);
      const Index first = tissues_[k].first_node;
      for (Index i = first; i < first + tissues_[k].node_count; ++i)
      {
        drags_[i] = damping * masses_[i];
      }
    }
  }
  if (!drags_.empty())
  {
    drag_ = std::make_unique<Drag>(drags_);
  }
}

void Scene::Impl::makeSolver()
{
  Adjacency all;
  std::vector<Index> held;
  all.offsets.push_back(0);
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const Tissue& tissue = tissues_[k];
    for (Index node = 0; node < tissue.node_count; ++node)
    {
      // What sleeps has no share in the matrix but ones on its diagonal.
      for (const Index* other = tissue.neighbours.begin(node);
           asleep_[k] == 0 && other != tissue.neighbours.end(node); ++other)
      {
        all.items.push_back(tissue.first_node + *other);
      }
      all.offsets.push_back(static_cast<Index>(all.items.size()));
    }
    for (const Index node : tissue_info_[k].fixed_nodes)
    {
      held.push_back(tissue.first_node + node);
    }
    for (Index node = 0; asleep_[k] != 0 && node < tissue.node_count; ++node)
    {
      held.push_back(tissue.first_node + node);
    }
  }
  for (const MovedNodes& moved : moved_)
  {
    held.insert(held.end(), moved.rows.begin(), moved.rows.end());
  }
  // Nodes in no element have no mass and feel no force: they stay where the file puts them.
  for (std::size_t i = 0; i < masses_.size(); ++i)
  {
    if (masses_[i] == 0.0)
    {
      held.push_back(static_cast<Index>(i));
    }
  }
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  newton_ = std::make_unique<NewtonSolver>(all, held, makeLinearSolver(config_.solver.linear));
  newton_options_.tolerance = config_.solver.tolerance;
  newton_options_.max_iterations = config_.solver.max_iterations;
  newton_options_.settled =
      tissue_info_.empty() ? 0.0 : kSettled * config_.solver.tolerance * smallestSize(tissue_info_);
}

}  // namespace soft_tissue
