#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "work_mesh.h"

namespace soft_tissue
{
namespace
{
/** Moves nodes one after the other; a move stays only if the worst tet around the node gets better.
 */
class ShapeImprover
{
 public:
  ShapeImprover(WorkMesh& work, const LevelFunction& surface, const LevelFunction& nodule)
      : work_(work),
        surface_(surface),
        nodule_(nodule),
        around_(nodeTets(static_cast<Index>(work.mesh.nodes.size()), work.mesh.tets)),
        neighbours_(nodeNeighbours(static_cast<Index>(work.mesh.nodes.size()), work.mesh.tets))
  {}

  /** @return true if any node moved */
  bool pass()
  {
    bool moved = false;
    for (Index node = 0; node < around_.size(); ++node)
    {
      moved = improve(node) || moved;
    }
    return moved;
  }

 private:
  double worstAround(Index node) const
  {
    const Points& x = work_.mesh.nodes;
    double worst = 1.0;
    for (const Index* t = around_.begin(node); t != around_.end(node); ++t)
    {
      const Tet& tet = work_.mesh.tets[*t];
      worst = std::min(worst, tetQuality(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]));
    }
    return worst;
  }

  /** Mean of the neighbours that are bound at least as the node is. */
  Vec3 meanOfNeighbours(Index node) const
  {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const Index* other = neighbours_.begin(node); other != neighbours_.end(node); ++other)
    {
      const std::uint8_t needed = work_.constraints[node];
      if ((work_.constraints[*other] & needed) == needed)
      {
        sum += work_.mesh.nodes[*other];
        ++count;
      }
    }
    return count > 0 ? Vec3(sum / count) : work_.mesh.nodes[node];
  }

  Vec3 gradient(const LevelFunction& level, const Vec3& p, bool in_plane) const
  {
    constexpr double kStep_m = 1e-6;
    Vec3 g = Vec3::Zero();
    for (int axis = 0; axis < (in_plane ? 2 : 3); ++axis)
    {
      const Vec3 step = kStep_m * Vec3::Unit(axis);
      g[axis] = (level(p + step) - level(p - step)) / (2.0 * kStep_m);
    }
    return g;
  }

  /** The point brought back to what the node must stay on. */
  Vec3 constrained(Index node, Vec3 p) const
  {
    const std::uint8_t bits = work_.constraints[node];
    const bool on_bottom = (bits & kOnBottom) != 0;
    if (on_bottom)
    {
      p.z() = 0.0;
    }
    if ((bits & (kOnSurface | kOnNodule)) != 0)
    {
      const LevelFunction& level = (bits & kOnSurface) != 0 ? surface_ : nodule_;
      for (int i = 0; i < 4; ++i)
      {
        const Vec3 g = gradient(level, p, on_bottom);
        p -= level(p) / std::max(g.squaredNorm(), 1e-30) * g;
      }
    }
    return p;
  }

  bool tryAt(Index node, const Vec3& p, double& best)
  {
    const Vec3 old = work_.mesh.nodes[node];
    work_.mesh.nodes[node] = constrained(node, p);
    const double quality = worstAround(node);
    if (quality > best + 1e-9)
    {
      best = quality;
      return true;
    }
    work_.mesh.nodes[node] = old;
    return false;
  }

  bool improve(Index node)
  {
    constexpr double kGoodEnough = 0.6;
    double best = worstAround(node);
    if (best > kGoodEnough)
    {
      return false;
    }
    const Vec3 way = meanOfNeighbours(node) - work_.mesh.nodes[node];
    const Vec3 start = work_.mesh.nodes[node];
    bool moved = false;
    for (const double part : {1.0, 0.5, 0.25, 0.1})
    {
      moved = moved || tryAt(node, start + part * way, best);
    }
    const Index* neighbour = neighbours_.begin(node);
    double edge = 1e300;
    for (; neighbour != neighbours_.end(node); ++neighbour)
    {
      edge = std::min(edge, (work_.mesh.nodes[*neighbour] - start).norm());
    }
    for (const double part : {0.2, 0.05})
    {
      for (int k = 0; k < 26; ++k)
      {
        const int code = k < 13 ? k : k + 1;  // the 26 directions of a 3 x 3 x 3 grid
        const Vec3 direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
        moved = tryAt(node, work_.mesh.nodes[node] + part * edge * direction, best) || moved;
      }
    }
    return moved;
  }

  WorkMesh& work_;
  const LevelFunction& surface_;
  const LevelFunction& nodule_;
  Adjacency around_;
  Adjacency neighbours_;
};
}  // namespace

void improveShapes(WorkMesh& work, const LevelFunction& surface, const LevelFunction& nodule)
{
  constexpr int kPasses = 12;
  ShapeImprover improver(work, surface, nodule);
  for (int i = 0; i < kPasses && improver.pass(); ++i)
  {}
}

}  // namespace soft_tissue
