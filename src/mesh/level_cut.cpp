#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh_scan.h"
#include "work_mesh.h"

namespace soft_tissue
{
namespace
{
/** Where between a (level >= 0 or <= 0) and b (the other sign) the level vanishes, in [0, 1] from
 * a. */
double crossing(const LevelFunction& level, const Vec3& a, const Vec3& b, bool a_inside)
{
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 50; ++i)
  {
    const double middle = 0.5 * (low + high);
    const bool inside = level(a + middle * (b - a)) > 0.0;
    (inside == a_inside ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/** Levels at the nodes; exactly zero on those that already lie on the zero set. */
std::vector<double> levelsOf(const WorkMesh& work, const LevelFunction& level,
                             Constraint constraint)
{
  std::vector<double> values(work.mesh.nodes.size());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = (work.constraints[i] & constraint) != 0 ? 0.0 : level(work.mesh.nodes[i]);
  }
  return values;
}

/** Cuts tets at a level and shares the new nodes between neighbours. */
class LevelCutter
{
 public:
  LevelCutter(WorkMesh& work, const LevelFunction& level, Constraint constraint)
      : work_(work),
        level_(level),
        constraint_(constraint),
        values_(levelsOf(work, level, constraint)),
        old_nodes_(static_cast<Index>(values_.size()))
  {}

  void cut(int outside_tag, int inside_tag);

 private:
  Index cutNode(Index inside, Index outside);
  /** Adds the part of the tet where sign * level > 0. */
  void addPart(const Tet& tet, double sign, int tag);
  void addPrism(std::array<Index, 6> prism, int tag);
  void addTet(const Tet& tet, int tag);
  /** The order in which the nodes of a quad get its diagonal: the same seen from both sides. */
  bool before(Index a, Index b) const
  {
    const bool a_new = a >= old_nodes_;
    const bool b_new = b >= old_nodes_;
    if (a_new || b_new)
    {
      return a_new == b_new ? a < b : b_new;
    }
    const double level_a = std::abs(values_[a]);
    const double level_b = std::abs(values_[b]);
    return level_a != level_b ? level_a < level_b : a < b;
  }

  WorkMesh& work_;
  const LevelFunction& level_;
  Constraint constraint_;
  std::vector<double> values_;
  Index old_nodes_;
  std::map<Edge, Index> cuts_;
  std::vector<Tet> tets_;
  std::vector<int> tags_;
};

Index LevelCutter::cutNode(Index inside, Index outside)
{
  const Index next = static_cast<Index>(work_.mesh.nodes.size());
  const auto [place, is_new] = cuts_.try_emplace(sortedKey(Edge{inside, outside}), next);
  if (is_new)
  {
    const Index a = place->first[0];
    const Index b = place->first[1];
    const Vec3 from = work_.mesh.nodes[a];
    const Vec3 way = work_.mesh.nodes[b] - from;
    work_.mesh.nodes.push_back(from +
                               crossing(level_, from, work_.mesh.nodes[b], values_[a] > 0.0) * way);
    const std::uint8_t shared = work_.constraints[a] & work_.constraints[b];
    work_.constraints.push_back(constraint_ | shared);
  }
  return place->second;
}

void LevelCutter::addTet(const Tet& tet, int tag)
{
  const Tet key = sortedKey(tet);
  if (std::adjacent_find(key.begin(), key.end()) == key.end())
  {
    tets_.push_back(tet);
    tags_.push_back(tag);
  }
}

void LevelCutter::addPrism(std::array<Index, 6> p, int tag)
{
  const auto less = [this](Index a, Index b) { return before(a, b); };
  const auto first = std::min_element(p.begin(), p.end(), less) - p.begin();
  if (first >= 3)
  {
    std::swap_ranges(p.begin(), p.begin() + 3, p.begin() + 3);
  }
  std::rotate(p.begin(), p.begin() + first % 3, p.begin() + 3);
  std::rotate(p.begin() + 3, p.begin() + 3 + first % 3, p.end());
  addTet({p[0], p[3], p[4], p[5]}, tag);
  const Index least = std::min({p[1], p[2], p[4], p[5]}, less);
  if (least == p[1] || least == p[5])
  {
    addTet({p[0], p[1], p[2], p[5]}, tag);
    addTet({p[0], p[1], p[5], p[4]}, tag);
  }
  else
  {
    addTet({p[0], p[1], p[2], p[4]}, tag);
    addTet({p[0], p[2], p[5], p[4]}, tag);
  }
}

void LevelCutter::addPart(const Tet& tet, double sign, int tag)
{
  std::vector<Index> in;
  std::vector<Index> rest;  // on the zero set or beyond it
  for (const Index node : tet)
  {
    (sign * values_[node] > 0.0 ? in : rest).push_back(node);
  }
  const auto end = [&](Index from, Index to) {
    return values_[to] == 0.0 ? to : cutNode(from, to);
  };
  const bool whole =
      std::all_of(rest.begin(), rest.end(), [&](Index n) { return values_[n] == 0.0; });
  if (in.empty())
  {
    return;
  }
  if (whole)
  {
    addTet(tet, tag);
  }
  else if (in.size() == 1)
  {
    addTet({in[0], end(in[0], rest[0]), end(in[0], rest[1]), end(in[0], rest[2])}, tag);
  }
  else if (in.size() == 2)
  {
    addPrism({in[0], end(in[0], rest[0]), end(in[0], rest[1]), in[1], end(in[1], rest[0]),
              end(in[1], rest[1])},
             tag);
  }
  else
  {
    addPrism({in[0], in[1], in[2], end(in[0], rest[0]), end(in[1], rest[0]), end(in[2], rest[0])},
             tag);
  }
}

void LevelCutter::cut(int outside_tag, int inside_tag)
{
  for (std::size_t t = 0; t < work_.mesh.tets.size(); ++t)
  {
    const Tet& tet = work_.mesh.tets[t];
    addPart(tet, 1.0, inside_tag != 0 ? inside_tag : work_.mesh.tags[t]);
    if (outside_tag != 0)
    {
      addPart(tet, -1.0, outside_tag);
      const bool flat =
          std::all_of(tet.begin(), tet.end(), [&](Index n) { return values_[n] == 0.0; });
      if (flat)  // all nodes on the zero set: neither side has claimed it
      {
        addTet(tet, outside_tag);
      }
    }
  }
  work_.mesh.tets = std::move(tets_);
  work_.mesh.tags = std::move(tags_);
}
}  // namespace

void snapToLevel(WorkMesh& work, const LevelFunction& level, Constraint constraint)
{
  constexpr double kReach = 0.35;  // part of an edge its end may move along it
  std::vector<double> values = levelsOf(work, level, constraint);
  Points& nodes = work.mesh.nodes;
  const auto node_count = static_cast<Index>(nodes.size());
  const Adjacency neighbours = nodeNeighbours(node_count, work.mesh.tets);
  for (Index node = 0; node < node_count; ++node)
  {
    const bool bottom = (work.constraints[node] & kOnBottom) != 0;
    if ((work.constraints[node] & ~kOnBottom) != 0)
    {
      continue;
    }
    double nearest = kReach;
    Vec3 target = nodes[node];
    for (const Index* other = neighbours.begin(node); other != neighbours.end(node); ++other)
    {
      const bool leaves_bottom = bottom && (work.constraints[*other] & kOnBottom) == 0;
      if (values[node] * values[*other] < 0.0 && !leaves_bottom)
      {
        const double t = crossing(level, nodes[node], nodes[*other], values[node] > 0.0);
        if (t < nearest)
        {
          nearest = t;
          target = nodes[node] + t * (nodes[*other] - nodes[node]);
        }
      }
    }
    if (nearest < kReach)
    {
      nodes[node] = target;
      values[node] = 0.0;
      work.constraints[node] |= constraint;
    }
  }
}

void cutAtLevel(WorkMesh& work, const LevelFunction& level, Constraint constraint, int outside_tag,
                int inside_tag)
{
  LevelCutter(work, level, constraint).cut(outside_tag, inside_tag);
}

void compact(WorkMesh& work)
{
  std::vector<Index> place(work.mesh.nodes.size(), -1);
  Points nodes;
  std::vector<std::uint8_t> constraints;
  for (Tet& tet : work.mesh.tets)
  {
    for (Index& node : tet)
    {
      if (place[node] < 0)
      {
        place[node] = static_cast<Index>(nodes.size());
        nodes.push_back(work.mesh.nodes[node]);
        constraints.push_back(work.constraints[node]);
      }
      node = place[node];
    }
    if (signedVolume6(nodes[tet[0]], nodes[tet[1]], nodes[tet[2]], nodes[tet[3]]) < 0.0)
    {
      std::swap(tet[2], tet[3]);
    }
  }
  work.mesh.nodes = std::move(nodes);
  work.constraints = std::move(constraints);
}

}  // namespace soft_tissue
