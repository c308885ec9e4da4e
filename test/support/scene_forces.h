#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/contact/tool_contact.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/scene/scene.h"
#include "soft_tissue_sim/scene/tissue_field.h"
#include "support/small_scenes.h"

namespace soft_tissue::test
{
/** A force and its moment about the world's origin. */
struct Load
{
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N m
  double size = 0.0;           ///< sum of the norms of the forces it is made of, N

  void add(const Vec3& point, const Vec3& part)
  {
    force += part;
    moment += point.cross(part);
    size += part.norm();
  }
};

/** The wrench a tool reports, about the world's origin. */
inline Load loadOn(const ToolState& tool)
{
  Load load;
  load.add(tool.X_WT.translation(), tool.wrench_W.force);
  load.moment += tool.wrench_W.torque;
  return load;
}

/** What else acts on the only tissue of a scene, from the energy terms and not from the scene. */
class TissueForces
{
 public:
  explicit TissueForces(const Scene& scene)
      : info_(scene.tissues()[0]),
        gravity_(scene.config().gravity_m_per_s2),
        masses_(info_.rest.nodes.size(), 0.0),
        elasticity_(info_.rest, material(scene).model,
                    {info_.rest.tets.size(),
                     {material(scene).young_modulus_pa, material(scene).poisson_ratio}},
                    0)
  {
    const std::vector<double> densities(info_.rest.tets.size(), material(scene).density_kg_per_m3);
    addLumpedMasses(info_.rest, densities, 0, masses_);
  }

  Load weight(const Points& x) const
  {
    Load load;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      load.add(x[i], masses_[i] * gravity_);
    }
    return load;
  }

  /** What its supports do to it: the force that keeps each fixed node in place. */
  Load support(const Points& x)
  {
    Points gradient(x.size(), Vec3::Zero());
    elasticity_.addGradient(x, gradient);
    Load load;
    for (const Index node : info_.fixed_nodes)
    {
      load.add(x[node], gradient[node] - masses_[node] * gravity_);
    }
    return load;
  }

 private:
  static const MaterialConfig& material(const Scene& scene)
  {
    return scene.config().tissues[0].material;
  }

  const TissueInfo& info_;
  Vec3 gravity_;
  std::vector<double> masses_;
  TetElasticity elasticity_;
};

/** The contact of a scene's only tool with its only tissue, made once more beside the scene. */
class ContactTwin
{
 public:
  ContactTwin(const Scene& scene, std::shared_ptr<const RigidShape> shape)
      : info_(scene.tissues()[0])
  {
    const auto count = static_cast<Index>(info_.rest.nodes.size());
    node_neighbours_ = nodeNeighbours(count, info_.rest.tets);
    RigidBodyShape tool;
    tool.add(std::move(shape), Pose::Identity());
    const ContactConfig& config = scene.config().contacts[0];
    ContactOptions options;
    options.segments = config.response == Response::segment;
    options.stiffness_pa_per_m = config.stiffness_pa_per_m.value();
    contact_ = std::make_unique<ToolContact>(
        TissueBody{&info_.rest.tets, &info_.surface, 0, count}, tool,
        makeDistanceField(scene.config().tissues[0].field, {&info_.surface, &node_neighbours_}),
        options);
  }

  /** What the tool does to the nodes at the end of a step that went from x0 to x. */
  Load onNodes(const Points& x0, const Pose& X_before, const Points& x, const Pose& X_after)
  {
    contact_->beginStep(x0, X_before, X_after, true);
    Points gradient(x.size(), Vec3::Zero());
    contact_->addGradient(x, gradient);
    Load load;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      load.add(x[i], -gradient[i]);
    }
    return load;
  }

 private:
  const TissueInfo& info_;
  Adjacency node_neighbours_;
  std::unique_ptr<ToolContact> contact_;
};

}  // namespace soft_tissue::test
