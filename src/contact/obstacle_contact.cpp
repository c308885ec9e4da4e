#include "soft_tissue_sim/contact/obstacle_contact.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "body_motion.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"
#include "tissue_in_tool.h"
#include "tool_grip.h"

namespace soft_tissue
{
namespace
{
/** How far beyond the tissue the obstacle is covered, in cells: as deep as it may get. */
constexpr double kCovered = 8.0;

RigidBodyShape bodyOf(const std::shared_ptr<VoxelShape>& shape, const Pose& X_WO)
{
  RigidBodyShape body;
  body.add(shape, X_WO);
  return body;
}
}  // namespace

struct ObstacleContact::Parts
{
  /** Has the obstacle's surface around a box of its frame. */
  void cover(Box3 reach_O)
  {
    reach_O.grow(kCovered * obstacle->cells().cellSize());
    obstacle->cover(reach_O);
    tissue_in_obstacle.place(Pose::Identity());
  }

  TissueBody tissue;
  std::shared_ptr<VoxelShape> obstacle;
  Pose X_OW;
  RigidBodyShape body;  ///< the obstacle in the world
  TissueInTool tissue_in_obstacle;

  Points start;         ///< the tissue at the start of the step
  double margin = 0.0;  ///< how far it may move before the selection is too small, m
  BoxSelection selection;
  Box3 changing;               ///< where the obstacle is about to change, world
  std::vector<double> excess;  ///< of elements, before that

  Parts(const TissueBody& tissue_body, std::shared_ptr<VoxelShape> shape, const Pose& X_WO,
        const ContactOptions& options)
      : tissue(tissue_body),
        obstacle(std::move(shape)),
        X_OW(X_WO.inverse()),
        body(bodyOf(obstacle, X_WO)),
        tissue_in_obstacle(tissue, body, options, 1.0)
  {}
};

ObstacleContact::ObstacleContact(const TissueBody& tissue, std::shared_ptr<VoxelShape> obstacle,
                                 const Pose& X_WO, const ContactOptions& options)
    : ContactTerm(options, {tissue}),
      parts_(std::make_unique<Parts>(tissue, std::move(obstacle), X_WO, options))
{}

ObstacleContact::~ObstacleContact() = default;

void ObstacleContact::beginStep(const Points& x)
{
  lagFriction(x);
  lagPlaces(x);
}

void ObstacleContact::lagFriction(const Points& x)
{
  if (!friction().acts())
  {
    return;
  }
  if (!haveSamplesAt(x))
  {
    lagPlaces(x);
  }
  const std::vector<ContactSample>& touching = samples(x);
  const ScopedTimer timer(times().respond);
  friction().begin(x);
  addGrips(touching, x, Pose::Identity(), friction());
}

void ObstacleContact::lagPlaces(const Points& x)
{
  Parts& p = *parts_;
  const ScopedTimer timer(times().detect);
  takeBodies(x);
  const double last_motion = p.start.empty() ? 0.0 : largestMotion(p.start, body(0));
  p.start = body(0);
  forgetSamples();
  p.margin = p.obstacle->innerRadius() + (std::isfinite(last_motion) ? last_motion : 0.0);
  select();
}

void ObstacleContact::select()
{
  Parts& p = *parts_;
  Box3 reach = boundsOf(p.start, p.tissue.surface->nodes);
  reach.grow(p.margin);
  const Box3 reach_O = transformed(p.X_OW, reach);
  p.selection.clear();
  p.cover(reach_O);
  if (p.obstacle->touches(reach_O))
  {
    p.selection.select(p.start, {}, *p.tissue.surface, reach);
  }
  p.tissue_in_obstacle.lagAreas(p.start, p.selection);
  p.tissue_in_obstacle.dropFarther(p.start, p.margin);
}

void ObstacleContact::collect(std::vector<ContactSample>& samples)
{
  Parts& p = *parts_;
  {
    const ScopedTimer timer(times().detect);
    // Areas are those of the start whatever is selected, so more elements only add what had been
    // out of reach.
    const double motion = largestMotion(p.start, body(0));
    if (motion > p.margin)
    {
      p.margin = std::isfinite(motion) ? 2.0 * motion : std::numeric_limits<double>::max() / 4.0;
      select();
    }
  }
  const ScopedTimer timer(times().respond);
  p.tissue_in_obstacle.addSamples(body(0), samples);
}

DepthCurvature ObstacleContact::curvature(const ContactSample& sample) const
{
  return parts_->tissue_in_obstacle.curvature(sample);
}

void ObstacleContact::setStiffness(double pa_per_m)
{
  parts_->tissue_in_obstacle.setStiffness(pa_per_m);
}

void ObstacleContact::beforeChange(const Points& x, const Box3& box_W)
{
  Parts& p = *parts_;
  takeBodies(x);
  forgetSamples();
  p.cover(transformed(p.X_OW, boundsOf(body(0), p.tissue.surface->nodes)));
  // The depth of what is near may change as well.
  p.changing = box_W;
  p.changing.grow(kCovered * p.obstacle->cells().cellSize());
  p.tissue_in_obstacle.findExcess(body(0), p.changing, p.excess);
}

void ObstacleContact::afterChange(const Points& x, const Pose& X_WO)
{
  Parts& p = *parts_;
  takeBodies(x);
  setPose(X_WO);
  p.cover(transformed(p.X_OW, boundsOf(body(0), p.tissue.surface->nodes)));
  p.tissue_in_obstacle.allowMore(body(0), p.changing, p.excess);
}

void ObstacleContact::allowAll(const Points& x)
{
  Parts& p = *parts_;
  setAllowances({});
  takeBodies(x);
  const Box3 bounds = boundsOf(body(0), p.tissue.surface->nodes);
  p.cover(transformed(p.X_OW, bounds));
  p.excess.assign(p.tissue_in_obstacle.elementCount(), 0.0);
  p.tissue_in_obstacle.allowMore(body(0), bounds, p.excess);
}

double ObstacleContact::easeAllowances(double by)
{
  forgetSamples();
  return parts_->tissue_in_obstacle.easeAllowances(by);
}

const std::vector<double>& ObstacleContact::allowances() const
{
  return parts_->tissue_in_obstacle.allowances();
}

void ObstacleContact::setAllowances(const std::vector<double>& depths_m)
{
  forgetSamples();
  if (!depths_m.empty() && depths_m.size() != parts_->tissue_in_obstacle.elementCount())
  {
    throw Error("obstacle: " + std::to_string(depths_m.size()) + " allowances for " +
                std::to_string(parts_->tissue_in_obstacle.elementCount()) + " elements");
  }
  parts_->tissue_in_obstacle.setAllowances(depths_m);
}

void ObstacleContact::addTo(StateHash& hash) const
{
  ContactTerm::addTo(hash);
  hash.add(allowances().data(), allowances().size() * sizeof(double));
}

void ObstacleContact::exchangePlaces(StateArchive& archive)
{
  Parts& p = *parts_;
  std::vector<double> allowed = allowances();
  archive.list(allowed);
  archive.list(p.start);
  archive.value(p.margin);
  if (archive.reading())
  {
    setAllowances(allowed);
    if (!p.start.empty())
    {
      select();
    }
  }
}

void ObstacleContact::setPose(const Pose& X_WO)
{
  parts_->X_OW = X_WO.inverse();
  parts_->body = bodyOf(parts_->obstacle, X_WO);
  forgetSamples();
}

bool ObstacleContact::active() const
{
  return parts_->tissue_in_obstacle.any();
}

}  // namespace soft_tissue
