#include "soft_tissue_sim/contact/tissue_contact.h"

#include <algorithm>
#include <array>
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
/** How far bodies may be from where they were expected before candidates are looked for anew, in
 * short edges; to this comes how far they were last step, up to a whole edge. */
constexpr double kMarginOfEdge = 0.25, kMostOff = 0.75;

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
  std::array<Points, 2> expected;     ///< and where they were expected to go
  double margin = 0.0;  ///< how much nearer bodies may come before candidates are too few, m
  bool near = false;    ///< there were candidates when the step began

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
  p.margin = 0.0;
  takeBodies(x);
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    const double off = p.start[k].empty() ? 0.0 : largestMotion(p.expected[k], body(k));
    const double edge = p.bodies[k].short_edge;
    p.margin += kMarginOfEdge * edge + std::min(off, kMostOff * edge);
    p.start[k] = body(k);
  }
  takeBodies(towards);
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    p.expected[k] = body(k);
  }
  forgetSamples();
  for (std::size_t k = 0; k < p.sides.size(); ++k)
  {
    p.sides[k].beginStep({&p.start[p.intruder(k)], &p.start[p.host(k)], &p.expected[p.intruder(k)],
                          &p.expected[p.host(k)]},
                         p.margin, refresh);
  }
  p.near = std::any_of(p.sides.begin(), p.sides.end(),
                       [](const TissueInTissue& side) { return side.hasCandidates(); });
}

// The energy stays the same function of x whatever the candidates: areas and depths are those of
// the start.
void TissueContact::collect(std::vector<ContactSample>& samples)
{
  Parts& p = *parts_;
  Timer timer;
  double motion = 0.0;
  for (std::size_t k = 0; k < p.bodies.size(); ++k)
  {
    motion += largestMotion(p.expected[k], body(k));
  }
  if (motion > p.margin)
  {
    for (std::size_t k = 0; k < p.bodies.size(); ++k)
    {
      p.expected[k] = body(k);
    }
    std::for_each(p.sides.begin(), p.sides.end(),
                  [&](TissueInTissue& side) { side.lookAround(p.margin); });
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
    archive.list(p.expected[k]);
  }
  archive.value(p.margin);
  archive.value(p.near);
  for (std::size_t k = 0; k < p.sides.size(); ++k)
  {
    if (archive.reading() && !p.start[0].empty())
    {
      p.sides[k].beginStep({&p.start[p.intruder(k)], &p.start[p.host(k)],
                            &p.expected[p.intruder(k)], &p.expected[p.host(k)]},
                           p.margin, false);
    }
    p.sides[k].exchange(archive);
  }
}

void TissueContact::forgetField()
{
  for (TissueInTissue& side : parts_->sides)
  {
    side.field().forget();
  }
}

}  // namespace soft_tissue
