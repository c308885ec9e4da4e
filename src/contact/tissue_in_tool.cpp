#include "tissue_in_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "moving_ends.h"
#include "soft_tissue_sim/collision/inside_intervals.h"

namespace soft_tissue
{
namespace
{
/** Places of a cell with a hint of their own: its begin and three quadrature points. What is
 * between one and the next, in the cell's length: */
constexpr std::array<double, 4> kBetween = {0.056, 0.306, 0.694, 0.944};
constexpr std::size_t kPlaces = kBetween.size();
}  // namespace

TissueInTool::TissueInTool(const TissueBody& tissue, const RigidBodyShape& tool,
                           const ContactOptions& options, double share)
    : tissue_(tissue),
      tool_(tool),
      options_(options),
      share_(share),
      cell_length_(0.5 * tool.innerRadius()),
      surface_(*tissue.surface, options, share),
      hints_(surface_.size())
{}

void TissueInTool::place(const Pose& X_WT)
{
  X_WT_ = X_WT;
  X_TW_ = X_WT.inverse();
  bounds_W_ = transformed(X_WT, tool_.bounds());
}

void TissueInTool::lagAreas(const Points& x, const BoxSelection& elements)
{
  near_.clear();
  if (options_.segments)
  {
    near_ = elements.surfaceEdges();
  }
  else
  {
    for (const Index node : elements.surfaceNodes())
    {
      near_.push_back(tissue_.surface->node_slot[node]);
    }
  }
  for (const Index element : near_)
  {
    surface_.lag(element, x, cell_length_);
  }
}

void TissueInTool::dropFarther(const Points& x, double margin)
{
  const auto outside = [&](Index element) {
    const Vec3& a = x[surface_.nodes(element)[0]];
    const Vec3& b = x[surface_.nodes(element)[1]];
    const double reach = 0.5 * (b - a).norm() + margin;
    return tool_.distance(X_TW_ * Vec3(0.5 * (a + b))).distance > reach;
  };
  near_.erase(std::remove_if(near_.begin(), near_.end(), outside), near_.end());
  if (!tool_.searches())
  {
    return;
  }
  for (const Index element : near_)
  {
    const std::size_t places = options_.segments ? kPlaces * surface_.all()[element].cells + 1 : 1;
    if (hints_[element].size() < places)
    {
      hints_[element].resize(places);
    }
  }
}

void TissueInTool::addSamples(const Points& x, std::vector<ContactSample>& samples) const
{
  for (const Index element : near_)
  {
    const std::size_t before = samples.size();
    if (options_.segments)
    {
      addEdge(element, x, samples);
    }
    else
    {
      addPoint(element, x, samples);
    }
    for (std::size_t i = before; i < samples.size(); ++i)
    {
      samples[i].element = element;
    }
  }
}

double TissueInTool::allowedTo(Index element) const
{
  return allowed_.empty() ? 0.0 : allowed_[element];
}

// Between the ends of an edge a wall may stand that none of them is in.
void TissueInTool::findExcess(const Points& x, const Box3& box_W, std::vector<double>& excess) const
{
  excess.assign(surface_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < surface_.size(); ++i)
  {
    const SurfaceElement& element = surface_.all()[i];
    const Vec3& a = x[element.nodes[0]];
    const Vec3 along = x[element.nodes[1]] - a;
    Box3 box;
    box.extend(a);
    box.extend(Vec3(a + along));
    if (!box.overlaps(box_W))
    {
      continue;
    }
    const int cells = cellsOf(along.norm(), cell_length_);
    for (int k = 0; k <= cells; ++k)
    {
      const Vec3 p = a + static_cast<double>(k) / cells * along;
      excess[i] = std::max(excess[i], -tool_.distance(X_TW_ * p).distance);
    }
    excess[i] -= allowedTo(static_cast<Index>(i));
  }
}

void TissueInTool::allowMore(const Points& x, const Box3& box_W, const std::vector<double>& excess)
{
  findExcess(x, box_W, deepest_);
  allowed_.resize(surface_.size(), 0.0);
  for (std::size_t i = 0; i < surface_.size(); ++i)
  {
    const double more = deepest_[i] - std::max(excess[i], 0.0);
    if (more > 0.0)
    {
      allowed_[i] += more;
    }
  }
}

double TissueInTool::easeAllowances(double by)
{
  double largest = 0.0;
  for (double& allowed : allowed_)
  {
    allowed = std::max(0.0, allowed - by);
    largest = std::max(largest, allowed);
  }
  if (largest == 0.0)
  {
    allowed_.clear();
  }
  return largest;
}

/** What was near a place of an element. */
NearestHint& TissueInTool::hintAt(Index element, double parameter) const
{
  std::vector<NearestHint>& hints = hints_[element];
  if (hints.empty())
  {
    return elsewhere_;
  }
  const double along = parameter * surface_.all()[element].cells;
  const double cell = std::floor(along);
  const std::size_t place = kPlaces * static_cast<std::size_t>(std::max(cell, 0.0)) +
                            std::count_if(kBetween.begin(), kBetween.end(),
                                          [&](double end) { return along - cell > end; });
  return hints[std::min(hints.size() - 1, place)];
}

bool TissueInTool::measure(const Vec3& p, Index number, double parameter, double weight,
                           ContactSample& sample) const
{
  const SurfaceElement& element = surface_.all()[number];
  const SignedDistance at = tool_.distance(X_TW_ * p, hintAt(number, parameter));
  sample.position = p;
  sample.depth = -at.distance;
  sample.gradient = -(X_WT_.linear() * at.normal);
  sample.area = share_ * weight * element.area;
  sample.stiffness_area = options_.stiffness_pa_per_m * element.per_area * sample.area;
  sample.allowed = allowedTo(number);
  sample.force = sample.stiffness_area * sample.excess();
  sample.side = -1;
  return sample.excess() > 0.0;
}

DepthCurvature TissueInTool::curvature(const ContactSample& sample) const
{
  const Mat3 R_WT = X_WT_.linear();
  const double parameter = sample.count == 2 ? sample.coefficient[1] : 0.0;
  DepthCurvature curvature;
  curvature.bend =
      -sample.depth *
      (R_WT * tool_.curvature(X_TW_ * sample.position, hintAt(sample.element, parameter)) *
       R_WT.transpose());
  return curvature;
}

void TissueInTool::addPoint(Index number, const Points& x,
                            std::vector<ContactSample>& samples) const
{
  const SurfaceElement& point = surface_.all()[number];
  const Index node = point.nodes[0];
  ContactSample sample;
  if (bounds_W_.contains(x[node]) && measure(x[node], number, 0.0, 1.0, sample))
  {
    addNodes(tissue_, point, 0.0, sample);
    samples.push_back(sample);
  }
}

// Cells wholly inside the tool keep their quadrature points; in a cell that crosses the surface
// they move with it, and MovingEnds accounts for that.
void TissueInTool::addEdge(Index number, const Points& x, std::vector<ContactSample>& samples) const
{
  const SurfaceElement& edge = surface_.all()[number];
  const auto& nodes = edge.nodes;
  const Vec3& a = x[nodes[0]];
  const Vec3 along = x[nodes[1]] - a;
  Box3 box;
  box.extend(a);
  box.extend(x[nodes[1]]);
  if (!box.overlaps(bounds_W_))
  {
    return;
  }
  const Vec3 along_T = X_TW_.linear() * along;
  const auto distance = [&](double parameter) {
    const SignedDistance at =
        tool_.distance(X_TW_ * Vec3(a + parameter * along), hintAt(number, parameter));
    return SegmentDistance{at.distance, at.normal.dot(along_T)};
  };
  const auto sampleAt = [&](double parameter, double weight, ContactSample& sample) {
    addNodes(tissue_, edge, parameter, sample);
    return measure(a + parameter * along, number, parameter, weight, sample);
  };
  forEachInsideInterval(distance, along.norm(), edge.cells, [&](const InsideInterval& inside) {
    addStretch(kGauss3, inside, along, sampleAt, samples);
  });
}

}  // namespace soft_tissue
