#include "tool_in_tissue.h"

#include <algorithm>

#include "moving_ends.h"
#include "quadrature.h"
#include "soft_tissue_sim/geometry/clip.h"

namespace soft_tissue
{
namespace
{
/** Barycentric weights this far below zero count as inside: shared faces leave no gap. */
constexpr double kInside = -1e-12;
/** Pieces of an edge with less than this share of it between them are one stretch. */
constexpr double kTouching = 1e-9;
}  // namespace

ToolInTissue::ToolInTissue(const TissueBody& tissue, const RigidBodyShape& tool,
                           const ToolContactOptions& options)
    : tissue_(tissue),
      options_(options),
      surface_(sampleToolSurface(tool)),
      depth_(tissue, options.closest_feature),
      nodes_W_(surface_.nodes.size()),
      boxes_W_(options.segments ? surface_.edges.size() : surface_.nodes.size())
{}

void ToolInTissue::place(const Pose& X_WT)
{
  for (std::size_t i = 0; i < surface_.nodes.size(); ++i)
  {
    nodes_W_[i] = X_WT * surface_.nodes[i];
  }
  for (std::size_t i = 0; i < boxes_W_.size(); ++i)
  {
    boxes_W_[i] = Box3();
    boxes_W_[i].extend(nodes_W_[options_.segments ? surface_.edges[i][0] : i]);
    boxes_W_[i].extend(nodes_W_[options_.segments ? surface_.edges[i][1] : i]);
  }
  grid_.build(boxes_W_);
}

bool ToolInTissue::findHosts(const Points& x, const std::vector<Index>& tets)
{
  hosts_.clear();
  found_ = false;
  point_host_.assign(options_.segments ? 0 : surface_.nodes.size(), -1);
  edge_hosts_.reset(options_.segments ? static_cast<Index>(surface_.edges.size()) : 0);
  for (const Index t : tets)
  {
    const Tet& tet = (*tissue_.tets)[t];
    Box3 box;
    for (const Index node : tet)
    {
      box.extend(x[node]);
    }
    if (!box.overlaps(grid_.bounds()))
    {
      continue;
    }
    const auto coords = tetCoordinates(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]);
    if (!coords)  // flat: it holds nothing
    {
      continue;
    }
    const Index number = static_cast<Index>(hosts_.size());
    hosts_.push_back({t, *coords});
    if (options_.segments)
    {
      hostEdges(hosts_.back(), number, box);
    }
    else
    {
      hostPoints(hosts_.back(), number, box);
    }
  }
  return found_;
}

void ToolInTissue::hostPoints(const Host& host, Index number, const Box3& box)
{
  grid_.forEachOverlap(box, [&](Index i) {
    if (point_host_[i] < 0 && host.coords.weights(nodes_W_[i]).minCoeff() >= kInside)
    {
      point_host_[i] = number;
      found_ = true;
    }
  });
}

void ToolInTissue::hostEdges(const Host& host, Index number, const Box3& box)
{
  grid_.forEachOverlap(box, [&](Index i) {
    const auto piece =
        clipSegment(nodes_W_[surface_.edges[i][0]], nodes_W_[surface_.edges[i][1]], host.coords);
    if (piece && piece->lambda1 < piece->lambda2)
    {
      edge_hosts_.add(i, number, {piece->lambda1, piece->lambda2});
      found_ = true;
    }
  });
}

void ToolInTissue::addSamples(const Points& x, const DistanceField& field,
                              std::vector<ContactSample>& samples)
{
  depth_.prepare(x);
  for (std::size_t i = 0; i < point_host_.size(); ++i)
  {
    ContactSample sample;
    if (point_host_[i] >= 0 &&
        measure(nodes_W_[i], hosts_[point_host_[i]], surface_.node_area[i], x, field, sample))
    {
      samples.push_back(sample);
    }
  }
  for (Index i = 0; options_.segments && i < static_cast<Index>(surface_.edges.size()); ++i)
  {
    if (options_.closest_feature)
    {
      addStretches(i, x, field, samples);
    }
    else
    {
      addPieces(i, x, field, samples);
    }
  }
}

// Interpolated depth is linear on each piece and continuous from piece to piece: two Gauss points
// integrate its square and the gradient of that exactly, however the pieces move.
void ToolInTissue::addPieces(Index edge, const Points& x, const DistanceField& field,
                             std::vector<ContactSample>& samples)
{
  for (const SegmentPiece& piece : edge_hosts_.disjointPieces(edge))
  {
    forEachPoint(kGauss2, piece.where, [&](double parameter, double weight) {
      ContactSample sample;
      if (measure(edgePoint(edge, parameter), hosts_[piece.host], weight * surface_.edge_area[edge],
                  x, field, sample))
      {
        samples.push_back(sample);
      }
    });
  }
}

// A true distance is not linear across a tet. The rule is laid over whole stretches inside the
// tissue, so only the tissue's surface moves its points, and MovingEnds accounts for that. Long
// edges are cut in fixed cells first: where a stretch falls apart only the rule of one cell jumps.
void ToolInTissue::addStretches(Index edge, const Points& x, const DistanceField& field,
                                std::vector<ContactSample>& samples)
{
  const std::vector<SegmentPiece>& pieces = edge_hosts_.disjointPieces(edge);
  const int cells = cellsOf(edge);
  for (std::size_t first = 0, last = 0; first < pieces.size(); first = ++last)
  {
    while (last + 1 < pieces.size() &&
           pieces[last + 1].where.begin - pieces[last].where.end < kTouching)
    {
      ++last;
    }
    const Interval inside = {pieces[first].where.begin, pieces[last].where.end};
    std::size_t at = first;
    const auto sampleAt = [&](double parameter, double area, ContactSample& sample) {
      while (at < last && pieces[at].where.end < parameter)
      {
        ++at;
      }
      return measure(edgePoint(edge, parameter), hosts_[pieces[at].host], area, x, field, sample);
    };
    const auto cellOf = [&](double parameter) { return static_cast<int>(parameter * cells); };
    double begin = inside.begin;
    for (int cell = cellOf(begin); begin < inside.end; ++cell)
    {
      const double end = std::min((cell + 1.0) / cells, inside.end);
      if (end > begin)  // rounding may put a begin on the cell's end
      {
        addStretch(edge, {begin, end}, begin > 0.0 && begin == inside.begin,
                   end < 1.0 && end == inside.end, sampleAt, samples);
        begin = end;
      }
    }
  }
}

template <typename SampleAt>
void ToolInTissue::addStretch(Index edge, const Interval& stretch, bool begin_moves, bool end_moves,
                              const SampleAt& sampleAt, std::vector<ContactSample>& samples) const
{
  const double area = surface_.edge_area[edge];
  MovingEnds ends(stretch, edgePoint(edge, 1.0) - edgePoint(edge, 0.0));
  ContactSample begin;
  if (begin_moves)
  {
    sampleAt(stretch.begin, area, begin);
  }
  forEachPoint(kGauss2, stretch, [&](double parameter, double weight) {
    ContactSample sample;
    if (sampleAt(parameter, weight * area, sample))
    {
      ends.count(sample, parameter);
      samples.push_back(sample);
    }
  });
  if (begin_moves && ends.close(begin, true))
  {
    samples.push_back(begin);
  }
  ContactSample end;
  if (end_moves)
  {
    sampleAt(stretch.end, area, end);
    if (ends.close(end, false))
    {
      samples.push_back(end);
    }
  }
}

bool ToolInTissue::measure(const Vec3& p, const Host& host, double area, const Points& x,
                           const DistanceField& field, ContactSample& sample) const
{
  if (!(area > 0.0) || !depth_.evaluate(p, host.tet, host.coords, x, field, sample))
  {
    return false;
  }
  sample.area = 0.5 * area;  // the two directions of the pair are averaged
  sample.stiffness_area = options_.stiffness_pa_per_m * sample.area;
  sample.force = sample.stiffness_area * sample.depth;
  sample.tool_sign = 1;
  return sample.depth > 0.0;
}

int ToolInTissue::cellsOf(Index edge) const
{
  constexpr double kMostCells = 1000.0;
  const double length = (edgePoint(edge, 1.0) - edgePoint(edge, 0.0)).norm();
  return tissue_.short_edge > 0.0
             ? static_cast<int>(std::min(length / tissue_.short_edge, kMostCells)) + 1
             : 1;
}

Vec3 ToolInTissue::edgePoint(Index edge, double parameter) const
{
  const Vec3& a = nodes_W_[surface_.edges[edge][0]];
  const Vec3& b = nodes_W_[surface_.edges[edge][1]];
  return a + parameter * (b - a);
}

}  // namespace soft_tissue
