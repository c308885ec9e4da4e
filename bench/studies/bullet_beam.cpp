#include "bullet_beam.h"

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/energy/mass_terms.h"

#ifdef SOFT_TISSUE_HAVE_BULLET_SOFT
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#endif

namespace soft_tissue::studies
{
#ifdef SOFT_TISSUE_HAVE_BULLET_SOFT
namespace
{
btVector3 toBullet(const Vec3& v)
{
  return btVector3(static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()),
                   static_cast<btScalar>(v.z()));
}
}  // namespace

struct BulletBeam::World
{
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableBodySolver body_solver;
  btDeformableMultiBodyConstraintSolver constraints;
  std::unique_ptr<btDeformableLagrangianForce> elasticity, weight;
  std::unique_ptr<btSoftBody> body;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world;
};

bool BulletBeam::available()
{
  return true;
}

BulletBeam::BulletBeam(const TetMesh& rest, const std::vector<Index>& fixed, bool neo_hookean,
                       const TetStiffnessParameters& stiffness, double density_kg_per_m3,
                       const Vec3& gravity)
    : world_(std::make_unique<World>())
{
  World& w = *world_;
  w.constraints.setDeformableSolver(&w.body_solver);
  w.world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
      &w.dispatcher, &w.broadphase, &w.constraints, &w.configuration, &w.body_solver);
  w.world->setGravity(toBullet(gravity));
  w.world->getWorldInfo().m_gravity = toBullet(gravity);
  w.world->getWorldInfo().m_dispatcher = &w.dispatcher;
  w.world->getWorldInfo().m_broadphase = &w.broadphase;
  w.world->getWorldInfo().m_sparsesdf.Initialize();
  w.world->setImplicit(true);
  w.world->setUseProjection(true);  // pinned nodes hold everything without it

  std::vector<double> masses(rest.nodes.size(), 0.0);
  addLumpedMasses(rest, std::vector<double>(rest.tets.size(), density_kg_per_m3), 0, masses);
  for (const Index node : fixed)
  {
    masses[node] = 0.0;  // what it means by pinned
  }
  std::vector<btVector3> nodes;
  std::vector<btScalar> weights(masses.begin(), masses.end());
  for (const Vec3& p : rest.nodes)
  {
    nodes.push_back(toBullet(p));
  }
  w.body = std::make_unique<btSoftBody>(&w.world->getWorldInfo(), static_cast<int>(nodes.size()),
                                        nodes.data(), weights.data());
  for (const Tet& tet : rest.tets)
  {
    w.body->appendTetra(tet[0], tet[1], tet[2], tet[3]);
  }
  w.body->initializeDmInverse();
  w.body->m_tetraScratches.resize(w.body->m_tetras.size());
  w.body->m_tetraScratchesTn.resize(w.body->m_tetras.size());
  w.body->m_cfg.collisions = 0;
  w.body->setSelfCollision(false);
  w.body->setActivationState(DISABLE_DEACTIVATION);
  w.world->addSoftBody(w.body.get());
  const Lame lame = lameFrom(stiffness.young_modulus, stiffness.poisson_ratio);
  const auto mu = static_cast<btScalar>(lame.mu), lambda = static_cast<btScalar>(lame.lambda);
  if (neo_hookean)
  {
    w.elasticity = std::make_unique<btDeformableNeoHookeanForce>(
        mu * btScalar(4) / btScalar(3), lambda + mu * btScalar(5) / btScalar(6), btScalar(0));
  }
  else
  {
    w.elasticity =
        std::make_unique<btDeformableLinearElasticityForce>(mu, lambda, btScalar(0), btScalar(0));
  }
  w.weight = std::make_unique<btDeformableGravityForce>(toBullet(gravity));
  w.world->addForce(w.body.get(), w.elasticity.get());
  w.world->addForce(w.body.get(), w.weight.get());
}

BulletBeam::~BulletBeam()
{
  world_->world->removeSoftBody(world_->body.get());
}

void BulletBeam::step(double step_s)
{
  world_->world->stepSimulation(static_cast<btScalar>(step_s), 0);
}

Points BulletBeam::positions() const
{
  Points x;
  for (int i = 0; i < world_->body->m_nodes.size(); ++i)
  {
    const btVector3& p = world_->body->m_nodes[i].m_x;
    x.emplace_back(p.x(), p.y(), p.z());
  }
  return x;
}
#else
struct BulletBeam::World
{};

bool BulletBeam::available()
{
  return false;
}

BulletBeam::BulletBeam(const TetMesh&, const std::vector<Index>&, bool,
                       const TetStiffnessParameters&, double, const Vec3&)
{
  throw Error("built without Bullet");
}

BulletBeam::~BulletBeam() = default;

void BulletBeam::step(double) {}

Points BulletBeam::positions() const
{
  return {};
}
#endif

}  // namespace soft_tissue::studies
