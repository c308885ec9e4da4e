#include "fcl_surfaces.h"

#ifdef SOFT_TISSUE_HAVE_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/utility.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#endif

namespace soft_tissue::studies
{
#ifdef SOFT_TISSUE_HAVE_FCL
using Model = fcl::BVHModel<fcl::AABBd>;

struct FclSurfaces::Models
{
  Model a, b;
};

namespace
{
void fill(Model& model, const std::vector<Triangle>& triangles, const Points& x)
{
  std::vector<fcl::Triangle> corners;
  for (const Triangle& t : triangles)
  {
    corners.emplace_back(t[0], t[1], t[2]);
  }
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(x.size()));
  model.addSubModel(x, corners);
  model.endModel();
}

void refit(Model& model, const Points& x)
{
  model.beginUpdateModel();
  model.updateSubModel(x);
  model.endUpdateModel(true, true);
}
}  // namespace

bool haveFcl()
{
  return true;
}

FclSurfaces::FclSurfaces(const std::vector<Triangle>& a, const Points& x_a,
                         const std::vector<Triangle>& b, const Points& x_b)
    : models_(std::make_unique<Models>())
{
  fill(models_->a, a, x_a);
  fill(models_->b, b, x_b);
}

std::size_t FclSurfaces::collide(const Points& x_a, const Points& x_b, bool inside)
{
  refit(models_->a, x_a);
  refit(models_->b, x_b);
  fcl::Transform3d identity_a = fcl::Transform3d::Identity(), identity_b = identity_a;
  const fcl::CollisionRequestd request(std::size_t{1} << 30, false);
  fcl::CollisionResultd result;
  if (!inside)
  {
    return fcl::collide(&models_->a, identity_a, &models_->b, identity_b, request, result);
  }
  fcl::detail::MeshCollisionTraversalNode<fcl::AABBd> node;
  if (fcl::detail::initialize(node, models_->a, identity_a, models_->b, identity_b, request,
                              result))
  {
    fcl::detail::collide(&node);
  }
  return result.numContacts();
}
#else
struct FclSurfaces::Models
{};

bool haveFcl()
{
  return false;
}

FclSurfaces::FclSurfaces(const std::vector<Triangle>&, const Points&, const std::vector<Triangle>&,
                         const Points&)
{}

std::size_t FclSurfaces::collide(const Points&, const Points&, bool)
{
  return 0;
}
#endif

FclSurfaces::~FclSurfaces() = default;

}  // namespace soft_tissue::studies
