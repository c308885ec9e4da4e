#include <algorithm>

#include "bodies.h"
#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/scene/tissue_field.h"

namespace soft_tissue
{
namespace
{
/** A tool may start touching, but not with more of its inner radius than this inside tissue. */
constexpr double kDeepStart = 0.5;

/** Tissues that start deeper in each other, in Contact::size_m, are pushed apart at a speed of so
 * many of them a second. */
constexpr double kDeepPair = 0.02, kEasing = 1.0;

/** Those that an obstacle took in are pushed out at so many of them, half cells, a second. */
constexpr double kObstacleEasing = 5.0;

/** The most parts that contact cuts edges of a membrane into. */
constexpr double kMostCuts = 64.0;

template <typename Named>
std::size_t find(const std::vector<Named>& all, const std::string& name)
{
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found - all.begin();
}

/** Whether nodal depths are marched anew in each step. */
bool refreshes(const FieldConfig& field)
{
  // Where the closest feature is searched for, features of any age start the search as well.
  const bool lazy = field.refresh == FieldRefresh::lazy && field.depth == DepthKind::interpolated;
  return lazy || field.refresh == FieldRefresh::full;
}

ContactOptions optionsOf(const ContactConfig& config, const FieldConfig& field, bool fine,
                         double stiffness)
{
  ContactOptions options;
  options.law = config.law;
  options.segments =
      config.response == Response::segment || (config.response == Response::automatic && !fine);
  options.closest_feature = field.depth == DepthKind::closest_feature;
  options.lazy_field = field.refresh == FieldRefresh::lazy;
  options.stiffness_pa_per_m = stiffness;
  options.friction = config.friction;
  options.damping_s_per_m = config.damping_s_per_m;
  return options;
}
}  // namespace

std::string Scene::Impl::itemOf(std::size_t tissue) const
{
  const std::size_t tissues = config_.tissues.size();
  return tissue < tissues ? item(config_, "tissues", tissue)
                          : item(config_, "membranes", tissue - tissues);
}

void Scene::Impl::addContact(std::size_t index)
{
  const ContactConfig& config = config_.contacts[index];
  Contact contact;
  contact.named = index;
  contact.tissue = find(tissue_info_, config.tissue);
  contact.max_penetration_m = config.max_penetration_m;
  if (find(config_.tools, config.other) < config_.tools.size())
  {
    addToolContacts(config, contact);
    return;
  }
  if (find(config_.obstacles, config.other) < config_.obstacles.size())
  {
    addObstacleContact(config, contact);
  }
  else
  {
    addTissueContact(config, contact);
  }
  contacts_.push_back(std::move(contact));
}

/** One of each part of the tool. */
void Scene::Impl::addToolContacts(const ContactConfig& config, const Contact& named)
{
  const std::size_t index = find(config_.tools, config.other);
  const FieldConfig field = fieldConfigOf(named.tissue);
  for (std::size_t part = 0; part < tools_[index].parts.size(); ++part)
  {
    const RigidBodyShape& shape = tools_[index].parts[part].shape;
    Contact contact;
    contact.tissue = named.tissue;
    contact.max_penetration_m = named.max_penetration_m;
    contact.other = index;
    contact.part = part;
    contact.named = named.named;
    contact.size_m = shape.innerRadius();
    contact.refresh = refreshes(field);
    auto term = std::make_unique<ToolContact>(
        surfaceFor(contact.size_m, config, contact), shape, fieldOf(contact.tissue),
        optionsOf(config, field, isFine(contact.tissue, contact.size_m),
                  stiffnessOf(config, contact)));
    contact.with_tool = term.get();
    contact.term = std::move(term);
    contacts_.push_back(std::move(contact));
  }
}

void Scene::Impl::addObstacleContact(const ContactConfig& config, Contact& contact)
{
  contact.other = find(config_.obstacles, config.other);
  const Obstacle& obstacle = obstacles_[contact.other];
  contact.size_m = obstacle.shape->innerRadius();
  auto term = std::make_unique<ObstacleContact>(
      surfaceFor(contact.size_m, config, contact), obstacle.shape, obstacle.X_WO,
      optionsOf(config, fieldConfigOf(contact.tissue), isFine(contact.tissue, contact.size_m),
                stiffnessOf(config, contact)));
  contact.with_obstacle = term.get();
  contact.term = std::move(term);
}

void Scene::Impl::addTissueContact(const ContactConfig& config, Contact& contact)
{
  contact.other = find(tissue_info_, config.other);
  const std::size_t first = contact.tissue, second = contact.other;
  contact.pair = pairs_.size();
  pairs_.push_back({static_cast<Index>(first), static_cast<Index>(second), {}});
  contact.size_m = innerRadiusOf(second);
  if (!tissue_info_[first].isMembrane())
  {
    contact.size_m = std::min(contact.size_m, innerRadiusOf(first));
  }
  const FieldConfig field = fieldConfigOf(tissue_info_[first].isMembrane() ? second : first);
  contact.refresh = refreshes(field);
  const ContactOptions options =
      optionsOf(config, field, isFine(first, contact.size_m) && isFine(second, contact.size_m),
                stiffnessOf(config, contact));
  TissueContact::Side a = {surfaceFor(tissues_[second].short_edge, config, contact),
                           fieldOf(first)};
  auto term = first == second ? std::make_unique<TissueContact>(std::move(a), options)
                              : std::make_unique<TissueContact>(
                                    std::move(a),
                                    TissueContact::Side{bodyOf(second), fieldOf(second)}, options);
  contact.with_tissue = term.get();
  contact.term = std::move(term);
}

/** Of contact as it is configured, or see kAutoStiffness. */
double Scene::Impl::stiffnessOf(const ContactConfig& config, const Contact& contact) const
{
  if (config.penalty || config.stiffness_pa_per_m)
  {
    return config.penalty ? *config.penalty : *config.stiffness_pa_per_m;
  }
  if (find(tissue_info_, config.other) == tissue_info_.size())
  {
    return stiffnessAgainstRigid(contact.tissue, contact.size_m);
  }
  double young_modulus = config_.softBody(contact.other).material.young_modulus_pa;
  if (!tissue_info_[contact.tissue].isMembrane())
  {
    young_modulus =
        std::min(young_modulus, config_.softBody(contact.tissue).material.young_modulus_pa);
  }
  return kAutoStiffness * young_modulus / contact.size_m;
}

/** Of a tool or obstacle with a soft body, see kAutoStiffness. */
double Scene::Impl::stiffnessAgainstRigid(std::size_t tissue, double radius_m) const
{
  const std::size_t tissues = config_.tissues.size();
  const double young_modulus = config_.softBody(tissue).material.young_modulus_pa;
  const double share =
      tissue < tissues ? 1.0 : config_.membranes[tissue - tissues].thickness_m / radius_m;
  return kAutoStiffness * young_modulus * share / radius_m;
}

/** Whether a soft body's edges are fine for contact with this radius, see kFineEdge. */
bool Scene::Impl::isFine(std::size_t tissue, double radius_m) const
{
  return edgeLength(tissue_info_[tissue], 0.5) < kFineEdge * radius_m;
}

double Scene::Impl::innerRadiusOf(std::size_t tissue)
{
  double& radius = tissues_[tissue].inner_radius;
  if (radius == 0.0)
  {
    radius = innerRadius(tissue_info_[tissue].rest, tissue_info_[tissue].surface);
  }
  return radius;
}

TissueBody Scene::Impl::bodyOf(std::size_t tissue) const
{
  const TissueInfo& info = tissue_info_[tissue];
  TissueBody body;
  body.tets = info.isMembrane() ? nullptr : &info.rest.tets;
  body.surface = &info.surface;
  body.first_node = tissues_[tissue].first_node;
  body.node_count = tissues_[tissue].node_count;
  body.short_edge = tissues_[tissue].short_edge;
  body.rest = &info.rest.nodes;
  return body;
}

/** The first body of a contact; a membrane is cut where its triangles are larger than the other
 * body, which would pass between their edges. */
TissueBody Scene::Impl::surfaceFor(double size_m, const ContactConfig& config,
                                   Contact& contact) const
{
  TissueBody body = bodyOf(contact.tissue);
  const TissueInfo& info = tissue_info_[contact.tissue];
  if (!info.isMembrane())
  {
    return body;
  }
  const double longest = edgeLength(info, 1.0);
  if (longest > kMostCuts * size_m)
  {
    throw Error(itemOf(contact.tissue) + " '" + info.name + "' has edges of " +
                std::to_string(1e3 * longest) + " mm, must be at most " +
                std::to_string(1e3 * kMostCuts * size_m) + " mm for contact with '" + config.other +
                "'");
  }
  if (longest > size_m)
  {
    contact.points = std::make_unique<SurfacePoints>(
        cutSurface({info.rest.nodes, info.surface.triangles}, size_m));
    body.points = contact.points.get();
    body.surface = &contact.points->surface;
    body.short_edge = std::min(body.short_edge, size_m);
  }
  return body;
}

FieldConfig Scene::Impl::fieldConfigOf(std::size_t tissue) const
{
  return tissue < config_.tissues.size() ? config_.tissues[tissue].field : FieldConfig();
}

/** Null for a membrane. */
std::unique_ptr<DistanceField> Scene::Impl::fieldOf(std::size_t tissue) const
{
  return tissue_info_[tissue].isMembrane()
             ? nullptr
             : makeDistanceField(config_.tissues[tissue].field,
                                 {&tissue_info_[tissue].surface, &tissues_[tissue].neighbours});
}

/** Tissues may start in each other: they are allowed it for a while. */
void Scene::Impl::findDeepStarts()
{
  for (Contact& contact : contacts_)
  {
    if (contact.with_tissue == nullptr || contact.tissue == contact.other)
    {
      continue;
    }
    contact.with_tissue->beginStep(x_, x_, true);
    const double deepest = contact.term->active() ? contact.term->deepest(x_) : 0.0;
    contact.start_depth_m = deepest > kDeepPair * contact.size_m ? deepest : 0.0;
    allow(contact.start_depth_m, contact);
    contact.term->forget();
  }
}

void Scene::Impl::allow(double depth_m, Contact& contact)
{
  contact.allowance_m = depth_m;
  contact.with_tissue->setAllowance(depth_m);
}

/** Pushes tissues that started in each other a little farther apart, and out of obstacles. */
void Scene::Impl::easeDeepStarts()
{
  for (Contact& contact : contacts_)
  {
    if (!(contact.allowance_m > 0.0))
    {
      continue;
    }
    const double by = contact.size_m * config_.time_step_s;
    if (contact.with_obstacle != nullptr)
    {
      contact.allowance_m = contact.with_obstacle->easeAllowances(kObstacleEasing * by);
    }
    else
    {
      allow(std::max(0.0, contact.allowance_m - kEasing * by), contact);
    }
  }
}

void Scene::Impl::refuseDeepStart()
{
  for (const Contact& contact : contacts_)
  {
    if (contact.with_obstacle != nullptr)
    {
      refuseDeepStart(contact);
    }
    if (contact.with_tool == nullptr)
    {
      continue;
    }
    const ToolPart& part = partOf(contact);
    contact.with_tool->beginStep(x_, part.X_WP, part.X_WP, true);
    const double deepest = contact.term->active() ? contact.term->deepest(x_) : 0.0;
    if (deepest > kDeepStart * contact.size_m)
    {
      throw Error(item(config_, "tools", contact.other) + " '" + config_.tools[contact.other].name +
                  "' starts " + std::to_string(1e3 * deepest) + " mm deep inside tissue '" +
                  tissue_info_[contact.tissue].name +
                  "', must start outside it: set initial_pose or the first key frame");
    }
  }
}

}  // namespace soft_tissue
