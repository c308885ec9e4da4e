#include "bullet_tets.h"

#include <cmath>

#ifdef SOFT_TISSUE_HAVE_BULLET
#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#endif

namespace soft_tissue::studies
{
#ifdef SOFT_TISSUE_HAVE_BULLET
namespace
{
/** Bullet's numbers are single: rounded outwards. */
btDbvtVolume volumeOf(const Tet& tet, const Points& x)
{
  Box3 box;
  for (const Index node : tet)
  {
    box.extend(x[node]);
  }
  btVector3 low, high;
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = std::nextafter(static_cast<btScalar>(box.min[axis]), -INFINITY);
    high[axis] = std::nextafter(static_cast<btScalar>(box.max[axis]), INFINITY);
  }
  return btDbvtVolume::FromMM(low, high);
}

struct Tree
{
  std::vector<Tet> tets;
  btDbvt boxes;
  std::vector<btDbvtNode*> leaves;

  void build(const std::vector<Tet>& own, const Points& x)
  {
    tets = own;
    for (std::size_t i = 0; i < tets.size(); ++i)
    {
      leaves.push_back(boxes.insert(volumeOf(tets[i], x), nullptr));
      leaves.back()->dataAsInt = static_cast<int>(i);
    }
    boxes.optimizeTopDown();
  }
  void update(const Points& x)
  {
    for (std::size_t i = 0; i < tets.size(); ++i)
    {
      btDbvtVolume volume = volumeOf(tets[i], x);
      boxes.update(leaves[i], volume);
    }
  }
};

struct Collector : btDbvt::ICollide
{
  std::vector<ElementPair>* pairs = nullptr;

  void Process(const btDbvtNode* a, const btDbvtNode* b) override
  {
    pairs->push_back({a->dataAsInt, b->dataAsInt});
  }
};
}  // namespace

struct BulletTets::Trees
{
  Tree a, b;
};

bool haveBullet()
{
  return true;
}

BulletTets::BulletTets(const std::vector<Tet>& a, const Points& x_a, const std::vector<Tet>& b,
                       const Points& x_b)
    : trees_(std::make_unique<Trees>())
{
  trees_->a.build(a, x_a);
  trees_->b.build(b, x_b);
}

void BulletTets::find(const Points& x_a, const Points& x_b, std::vector<ElementPair>& pairs)
{
  trees_->a.update(x_a);
  trees_->b.update(x_b);
  pairs.clear();
  Collector collector;
  collector.pairs = &pairs;
  trees_->a.boxes.collideTT(trees_->a.boxes.m_root, trees_->b.boxes.m_root, collector);
}
#else
struct BulletTets::Trees
{};

bool haveBullet()
{
  return false;
}

BulletTets::BulletTets(const std::vector<Tet>&, const Points&, const std::vector<Tet>&,
                       const Points&)
{}

void BulletTets::find(const Points&, const Points&, std::vector<ElementPair>&) {}
#endif

BulletTets::~BulletTets() = default;

}  // namespace soft_tissue::studies
