#include "soft_tissue_sim/contact/tissue_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "body_motion.h"
#include "friction.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "tissue_in_tissue.h"

namespace soft_tissue
{
namespace
{
/** Candidates are looked for with a margin that lasts for so many steps of the motion since the
 * last time, but not a smaller one than this or a larger one than that, in short edges of both
 * bodies: what is gained by looking seldom is lost with too many candidates. */
constexpr double kStepsAhead = 8.0, kLeastMargin = 0.02, kMostMargin = 0.25;
/** Bodies are not watched in a step only if nothing is nearer than this at its end. */
constexpr double kWatched = 0.25;
/** Candidates are looked for anew where their margin is so many times what it had to be. */
constexpr double kTooWide = 4.0;
/** A step is taken to go so many times as much farther than it is expected to as the last ones, of
 * which each counts so much less than the next; up to so many short edges. */
constexpr double kFarther = 2.0, kFades = 0.5, kMostFarther = 0.75;

const TissueBody& withRest(const TissueBody& body)
{
  if (body.rest == nullptr)
  {
    throw Error("a tissue that touches itself needs its nodes at rest");
  }
  return body;
}
}  // namespace

struct TissueContact::Parts
{
  std::vector<TissueBody> bodies;     ///< one, or two
  std::vector<TissueInTissue> sides;  ///< of one body the one, of two: first in second, and back,
                                      ///< if it can
  std::array<Points, 2> start;        ///< of bodies, at the start of the step
  std::array<Points, 2> looked_at;    ///< where they were when candidates were looked for
  double margin = 0.0;    ///< how much they may move in all before candidates are too few, m
  double expected = 0.0;  ///< how much they were expected to have moved by the end of the step, m
  double farther = 0.0;   ///< how much more it has been, m
  int steps = 0;          ///< begun since candidates were looked for
  bool near = false;      ///< there are candidates, or there may be within the step

  /** The body that has the tets of a side. */
  std::size_t host(std::size_t side) const { return bodies.size() - 1 - side; }
  /** The body whose surface is the side's. */
  std::size_t intruder(std::size_t side) const { return side; }
};

TissueContact::TissueContact(Side first, Side second, const ContactOptions& options)
    : ContactTerm(options, {first.body, second.body}), parts_(std::make_unique<Parts>())
{
  if (!second.body.isSolid())
  {
    throw Error("the second of two tissues in contact is a membrane, which has no inside");
  }
  Parts& p = *parts_;
  p.bodies = {first.body, second.body};
  p.sides.emplace_back(first.body, second.body, std::move(second.field), 1, false, options);
  if (first.body.isSolid())
  {
    p.sides.emplace_back(second.body, first.body, std::move(first.field), -1, false, options);
  }
}

TissueContact::TissueContact(Side self, const ContactOptions& options)
    : ContactTerm(options, {self.body}), parts_(std::make_unique<Parts>())
{
  parts_->bodies = {withRest(self.body)};
  parts_->sides.emplace_back(self.body, self.body, std::move(self.field), 1, true, options);
}

TissueContact::~TissueContact() = default;

void TissueContact::beginStep(const Points& x, const Points& towards, bool refresh)
{
  lagFriction(x, refresh);
  lagPlaces(x, towards, refresh);
}

/** Friction of a step is that of the contacts it starts with. It acts between the points of both
 * bodies that are at one place, so it turns nothing. */
void TissueContact::lagFriction(const Points& x, bool refresh)
{
  if (!friction().acts())
  {
    return;
  }
  if (!haveSamplesAt(x))
  {
    lagPlaces(x, x, refresh);
  }
  const std::vector<ContactSample>& touching = samples(x);
  const ScopedTimer timer(times().respond);
  friction().begin(x);
  forEachPress(touching, [&](const ContactSample& sample, std::uint64_t place) {
    addGrip(sample, place, x);
  });
}

void TissueContact::addGrip(const ContactSample& sample, std::uint64_t place, const Points& x)
{
  const Parts& p = *parts_;
  const std::size_t host = p.host(sample.side > 0 ? 0 : 1);
  const Tet& tet = (*p.bodies[host].tets)[sample.host];
  const Index row = p.bodies[host].first_node;
  const auto coords =
      tetCoordinates(x[row + tet[0]], x[row + tet[1]], x[row + tet[2]], x[row + tet[3]]);
  if (!coords)
  {
    return;
  }
  const Eigen::Vector4d weights = coords->weights(sample.position);
  Grip grip;
  grip.place = place;
  grip.normal = sample.normal();
  grip.press = sample.force;
  for (int k = 0; k < 4; ++k)
  {
    grip.node[grip.count] = row + tet[k];
    grip.weight[grip.count++] = sample.side * weights[k];
  }
  for (int j = options().closest_feature ? 3 : 4; j < sample.count; ++j)  // the intruder's
  {
    grip.node[grip.count] = sample.node[j];
    grip.weight[grip.count++] = -sample.side * sample.coefficient[j];
  }
  grip.stuck_at = grip.at(x);
  grip.origin = sample.position - grip.stuck_at;
  friction().add(grip);
}

void TissueContact::lagPlaces(const Points& x, const Points& towards, bool refresh)
{
  Parts& p = *parts_;
  const ScopedTimer timer(times().detect);
  takeBodies(x);
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    p.start[k] = body(k);
  }
  beginSides(refresh);
  takeBodies(towards);
  forgetSamples();
  ++p.steps;
  p.expected = motionSinceLook();
  const double room = kFarther * p.farther;
  p.farther *= kFades;
  const double wanted = marginFor(kStepsAhead * p.expected / p.steps, room);
  const double watched = kWatched * shortEdges();
  p.near = haveCandidates();
  const bool too_wide = p.near && p.steps > kStepsAhead && kTooWide * wanted < p.margin;
  if (!(p.expected + room + (p.near ? 0.0 : watched) <= p.margin) || too_wide)
  {
    lookAround(wanted);
    p.near = haveCandidates();
  }
  if (!p.near && p.margin < p.expected + watched)  // there is little to find: it may be looked far
  {
    lookAround(2.0 * watched);
    p.near = haveCandidates();
  }
}

void TissueContact::beginSides(bool refresh)
{
  Parts& p = *parts_;
  for (std::size_t k = 0; k < p.sides.size(); ++k)
  {
    p.sides[k].beginStep({&p.start[p.intruder(k)], &p.start[p.host(k)]}, refresh);
  }
}

/** Of both bodies, m; infinite before the first look. */
double TissueContact::motionSinceLook() const
{
  const Parts& p = *parts_;
  double motion = 0.0;
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    motion += p.looked_at[k].empty() ? std::numeric_limits<double>::infinity()
                                     : largestMotion(p.looked_at[k], body(k));
  }
  return motion;
}

/** What to look for candidates with, m.
 * @param ahead  motion that it is to last for
 * @param room   beside that */
double TissueContact::marginFor(double ahead, double room) const
{
  const double edges = shortEdges();
  return std::clamp(std::isfinite(ahead) ? ahead : 0.0, kLeastMargin * edges, kMostMargin * edges) +
         std::min(room, kMostFarther * edges);
}

/** Of both bodies, m. */
double TissueContact::shortEdges() const
{
  double edges = 0.0;
  for (const TissueBody& body : parts_->bodies)
  {
    edges += body.short_edge;
  }
  return edges;
}

bool TissueContact::haveCandidates() const
{
  return std::any_of(parts_->sides.begin(), parts_->sides.end(),
                     [](const TissueInTissue& side) { return side.hasCandidates(); });
}

/** For candidates where bodies are now. */
void TissueContact::lookAround(double margin)
{
  Parts& p = *parts_;
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    p.looked_at[k] = body(k);
  }
  p.margin = margin;
  p.expected = 0.0;
  p.steps = 0;
  lookAgain();
}

/** The same look once more. */
void TissueContact::lookAgain()
{
  Parts& p = *parts_;
  for (std::size_t k = 0; k < p.sides.size(); ++k)
  {
    p.sides[k].lookAround({&p.looked_at[p.intruder(k)], &p.looked_at[p.host(k)]}, p.margin);
  }
}

// The energy stays the same function of x whatever the candidates: areas and depths are those of
// the start.
void TissueContact::collect(std::vector<ContactSample>& samples)
{
  Parts& p = *parts_;
  Timer timer;
  const double motion = motionSinceLook();
  p.farther = std::max(p.farther, motion - p.expected);
  if (!(motion <= p.margin))
  {
    lookAround(marginFor(kFarther * motion, 0.0));
  }
  for (std::size_t k = 0; k < p.sides.size(); ++k)
  {
    timer.restart();
    const bool found = p.sides[k].find(body(p.intruder(k)), body(p.host(k)));
    times().detect += timer.restart();
    if (found)
    {
      p.sides[k].addSamples(samples);
      const double marched_s = p.sides[k].field().takeTime();
      times().field += marched_s;
      times().respond += timer.seconds() - marched_s;
    }
  }
}

DepthCurvature TissueContact::curvature(const ContactSample& sample) const
{
  return parts_->sides[sample.side > 0 ? 0 : 1].curvature(sample);
}

void TissueContact::setStiffness(double pa_per_m)
{
  for (TissueInTissue& side : parts_->sides)
  {
    side.setStiffness(pa_per_m);
  }
}

void TissueContact::setAllowance(double depth_m)
{
  forgetSamples();
  for (TissueInTissue& side : parts_->sides)
  {
    side.setAllowance(depth_m);
  }
}

// Where bodies are taken apart in the course of a minimisation they may come back.
bool TissueContact::active() const
{
  return parts_->near;
}

void TissueContact::exchangePlaces(StateArchive& archive)
{
  Parts& p = *parts_;
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    archive.list(p.start[k]);
    archive.list(p.looked_at[k]);
  }
  archive.value(p.margin);
  archive.value(p.expected);
  archive.value(p.farther);
  archive.value(p.steps);
  archive.value(p.near);
  if (archive.reading() && !p.start[0].empty())
  {
    beginSides(false);
    lookAgain();
  }
  for (TissueInTissue& side : p.sides)
  {
    side.exchange(archive);
  }
}

void TissueContact::forgetPlaces()
{
  for (TissueInTissue& side : parts_->sides)
  {
    side.field().forget();
  }
  parts_->looked_at = {};
}

}  // namespace soft_tissue
