#include "surface_in_tissue.h"

#include <algorithm>

#include "moving_ends.h"

namespace soft_tissue
{
namespace
{
/** Pieces of an edge with less than this share of it between them are one stretch. */
constexpr double kTouching = 1e-9;
/** Of a quadrature rule and both ends. */
constexpr int kPointsOfCell = 4;
}  // namespace

SurfaceInTissue::SurfaceInTissue(const TissueBody& host, const Intruder& intruder,
                                 const ContactOptions& options)
    : host_(host),
      intruder_(intruder),
      segments_(options.segments),
      closest_feature_(options.closest_feature),
      stiffness_(options.stiffness_pa_per_m),
      depth_(host, options.closest_feature)
{}

bool SurfaceInTissue::findHosts(const std::vector<SurfaceElement>& elements,
                                const ElementSet& numbers, const Points& nodes, const Points& x,
                                const std::vector<ElementPair>& candidates)
{
  elements_ = &elements;
  nodes_ = &nodes;
  x_ = &x;
  for (const Index element : held_)
  {
    point_host_[element] = -1;
  }
  held_.clear();
  point_host_.resize(elements.size(), -1);
  edge_hosts_.reset(static_cast<Index>(elements.size()));
  clipPairs(numbers, nodes.data(), tetsOf(host_), x.data(), candidates, clipped_);
  for (const ClippedPair& clipped : clipped_)
  {
    const Index element = clipped.pair.first;
    if (point_host_[element] < 0)
    {
      point_host_[element] = clipped.pair.second;
      held_.push_back(element);
    }
    if (segments_)
    {
      edge_hosts_.add(element, clipped.pair.second, clipped.where);
    }
  }
  std::sort(held_.begin(), held_.end());
  return !held_.empty();
}

void SurfaceInTissue::addSamples(const DistanceField& field, std::vector<ContactSample>& samples)
{
  if (held_.empty())
  {
    return;
  }
  depth_.prepare(*x_);
  near_.restart();
  for (const Index element : held_)
  {
    hint_ = -1;
    if (!segments_)
    {
      addPoint(element, field, samples);
    }
    else if (closest_feature_)
    {
      addStretches(element, field, samples);
    }
    else
    {
      addPieces(element, field, samples);
    }
  }
}

void SurfaceInTissue::addPoint(Index element, const DistanceField& field,
                               std::vector<ContactSample>& samples)
{
  ContactSample sample;
  if (measure({element, 0.0, point_host_[element], (*elements_)[element].area, 0}, field, sample))
  {
    samples.push_back(sample);
  }
}

// Interpolated depth is linear on each piece and continuous from piece to piece: two Gauss points
// integrate its square and the gradient of that exactly, however the pieces move.
void SurfaceInTissue::addPieces(Index edge, const DistanceField& field,
                                std::vector<ContactSample>& samples)
{
  for (const SegmentPiece& piece : edge_hosts_.disjointPieces(edge))
  {
    forEachPoint(kGauss2, piece.where, [&](double parameter, double weight) {
      ContactSample sample;
      if (measure({edge, parameter, piece.host, weight * (*elements_)[edge].area, 0}, field,
                  sample))
      {
        samples.push_back(sample);
      }
    });
  }
}

// A true distance is not linear across a tet. The rule is laid over whole stretches inside the
// tissue, so only the tissue's surface moves its points, and MovingEnds accounts for that. Long
// edges are cut in fixed cells first: where a stretch falls apart only the rule of one cell jumps.
void SurfaceInTissue::addStretches(Index edge, const DistanceField& field,
                                   std::vector<ContactSample>& samples)
{
  const std::vector<SegmentPiece>& pieces = edge_hosts_.disjointPieces(edge);
  const int cells = (*elements_)[edge].cells;
  const double area = (*elements_)[edge].area;
  for (std::size_t first = 0, last = 0; first < pieces.size(); first = ++last)
  {
    while (last + 1 < pieces.size() &&
           pieces[last + 1].where.begin - pieces[last].where.end < kTouching)
    {
      ++last;
    }
    const Interval inside = {pieces[first].where.begin, pieces[last].where.end};
    std::size_t at = first;
    int number = 0;
    const auto sampleAt = [&](double parameter, double weight, ContactSample& sample) {
      while (at < last && pieces[at].where.end < parameter)
      {
        ++at;
      }
      return measure({edge, parameter, pieces[at].host, weight * area, number++}, field, sample);
    };
    const auto cellOf = [&](double parameter) { return static_cast<int>(parameter * cells); };
    double begin = inside.begin;
    for (int cell = cellOf(begin); begin < inside.end; ++cell)
    {
      const double end = std::min((cell + 1.0) / cells, inside.end);
      if (end > begin)  // rounding may put a begin on the cell's end
      {
        number = kPointsOfCell * cell + (begin > 0.0 && begin == inside.begin ? 0 : 1);
        addStretch(
            kGauss2,
            {{begin, end}, begin > 0.0 && begin == inside.begin, end < 1.0 && end == inside.end},
            edgeVector(edge), sampleAt, samples);
        begin = end;
      }
    }
  }
}

/** Where the point of an element is while its body is at rest. */
Vec3 SurfaceInTissue::restPoint(const Place& place) const
{
  const auto& nodes = (*elements_)[place.element].nodes;
  const Vec3& a = (*intruder_.rest)[nodes[0]];
  return a + place.parameter * ((*intruder_.rest)[nodes[1]] - a);
}

bool SurfaceInTissue::measure(const Place& place, const DistanceField& field, ContactSample& sample)
{
  const Vec3& a = end(place.element, 0);
  const Vec3 p = a + place.parameter * (end(place.element, 1) - a);
  if (!(place.area > 0.0))
  {
    return false;
  }
  NearBoundary& near = near_.of(place.element, place.number);
  near.hint = near.hint < 0 ? hint_ : near.hint;
  const bool found = intruder_.rest == nullptr
                         ? depth_.evaluate(p, place.host, *x_, field, near, sample)
                         : depth_.evaluateSelf(p, place.host, *x_, field, *intruder_.rest,
                                               restPoint(place), near, sample);
  hint_ = near.hint;
  if (!found)
  {
    return false;
  }
  if (intruder_.body)
  {
    addNodes(*intruder_.body, (*elements_)[place.element], place.parameter, sample);
  }
  sample.host = place.host;
  sample.element = place.element;
  sample.side = intruder_.side;
  sample.area = intruder_.share * place.area;
  sample.stiffness_area = stiffness_ * (*elements_)[place.element].per_area * sample.area;
  sample.allowed = allowance_;
  sample.force = sample.stiffness_area * sample.excess();
  return sample.excess() > 0.0;
}

Vec3 SurfaceInTissue::edgeVector(Index edge) const
{
  return end(edge, 1) - end(edge, 0);
}

}  // namespace soft_tissue
