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

template <typename Configs>
std::size_t find(const Configs& configs, const std::string& name)
{
  const auto found =
      std::find_if(configs.begin(), configs.end(), [&](const auto& c) { return c.name == name; });
  return found - configs.begin();
}

/** The length a tenth of a tissue's boundary edges fall short of, m. */
double shortEdge(const TissueInfo& tissue)
{
  std::vector<double> lengths;
  for (const Edge& edge : tissue.surface.edges)
  {
    lengths.push_back((tissue.rest.nodes[edge[1]] - tissue.rest.nodes[edge[0]]).norm());
  }
  const auto tenth = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 10);
  std::nth_element(lengths.begin(), tenth, lengths.end());
  return *tenth;
}
}  // namespace

void Scene::Impl::addContact(std::size_t index)
{
  const ContactConfig& config = config_.contacts[index];
  Contact contact;
  contact.tissue = find(config_.tissues, config.tissue);
  const FieldConfig& field = config_.tissues[contact.tissue].field;
  ContactOptions options;
  options.segments = config.response == Response::segment;
  options.closest_feature = field.depth == DepthKind::closest_feature;
  options.lazy_field = field.refresh == FieldRefresh::lazy;
  options.friction = config.friction;
  // Where the closest feature is searched for, features of any age start the search as well.
  const bool lazy_depths = options.lazy_field && !options.closest_feature;
  contact.refresh = lazy_depths || field.refresh == FieldRefresh::full;
  contact.max_penetration_m = config.max_penetration_m;
  if (find(config_.tools, config.other) < config_.tools.size())
  {
    addToolContact(config, options, contact);
  }
  else if (find(config_.obstacles, config.other) < config_.obstacles.size())
  {
    addObstacleContact(config, options, contact);
  }
  else
  {
    addTissueContact(config, options, contact);
  }
  contacts_.push_back(std::move(contact));
}

void Scene::Impl::addToolContact(const ContactConfig& config, ContactOptions options,
                                 Contact& contact)
{
  contact.other = find(config_.tools, config.other);
  const RigidBodyShape& shape = tools_[contact.other].shape;
  contact.size_m = shape.innerRadius();
  const double young_modulus = config_.tissues[contact.tissue].material.young_modulus_pa;
  options.stiffness_pa_per_m =
      config.stiffness_pa_per_m.value_or(kAutoStiffness * young_modulus / contact.size_m);
  auto term = std::make_unique<ToolContact>(bodyOf(contact.tissue), shape, fieldOf(contact.tissue),
                                            options);
  contact.with_tool = term.get();
  contact.term = std::move(term);
}

void Scene::Impl::addTissueContact(const ContactConfig& config, ContactOptions options,
                                   Contact& contact)
{
  contact.other = find(config_.tissues, config.other);
  const std::size_t first = contact.tissue, second = contact.other;
  contact.pair = pairs_.size();
  pairs_.push_back({static_cast<Index>(first), static_cast<Index>(second), {}});
  contact.size_m = std::min(innerRadius(tissue_info_[first].rest, tissue_info_[first].surface),
                            innerRadius(tissue_info_[second].rest, tissue_info_[second].surface));
  const double young_modulus = std::min(config_.tissues[first].material.young_modulus_pa,
                                        config_.tissues[second].material.young_modulus_pa);
  options.stiffness_pa_per_m =
      config.stiffness_pa_per_m.value_or(kAutoStiffness * young_modulus / contact.size_m);
  TissueContact::Side a = {bodyOf(first), fieldOf(first)};
  auto term = first == second ? std::make_unique<TissueContact>(std::move(a), options)
                              : std::make_unique<TissueContact>(
                                    std::move(a),
                                    TissueContact::Side{bodyOf(second), fieldOf(second)}, options);
  contact.with_tissue = term.get();
  contact.term = std::move(term);
}

TissueBody Scene::Impl::bodyOf(std::size_t tissue) const
{
  const TissueInfo& info = tissue_info_[tissue];
  TissueBody body;
  body.tets = &info.rest.tets;
  body.surface = &info.surface;
  body.first_node = tissues_[tissue].first_node;
  body.node_count = tissues_[tissue].node_count;
  body.short_edge = shortEdge(info);
  body.rest = &info.rest.nodes;
  return body;
}

std::unique_ptr<DistanceField> Scene::Impl::fieldOf(std::size_t tissue) const
{
  return makeDistanceField(config_.tissues[tissue].field,
                           {&tissue_info_[tissue].surface, &tissues_[tissue].neighbours});
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
    const Tool& tool = tools_[contact.other];
    contact.with_tool->beginStep(x_, tool.X_WT, tool.X_WT, true);
    const double deepest = contact.term->active() ? contact.term->deepest(x_) : 0.0;
    if (deepest > kDeepStart * contact.size_m)
    {
      throw Error(item(config_, "tools", contact.other) + " '" + config_.tools[contact.other].name +
                  "' starts " + std::to_string(1e3 * deepest) + " mm deep inside tissue '" +
                  config_.tissues[contact.tissue].name +
                  "', must start outside it: set initial_pose or the first key frame");
    }
  }
}

}  // namespace soft_tissue
