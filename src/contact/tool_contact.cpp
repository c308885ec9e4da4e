#include "soft_tissue_sim/contact/tool_contact.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "body_motion.h"
#include "host_field.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "tissue_in_tool.h"
#include "tool_grip.h"
#include "tool_in_tissue.h"

namespace soft_tissue
{
namespace
{
/** How far a body may move before more of it is looked at, in the tool's inner radius, to which
 * comes what it moved last step. */
constexpr double kMarginOfRadius = 0.5;

const std::vector<Tet> kNoTets;
const std::vector<double> kNoDepths;
}  // namespace

struct ToolContact::Parts
{
  TissueBody tissue;
  RigidBodyShape tool;
  std::optional<HostField> field;  ///< of the tissue; none of a membrane
  std::optional<ToolInTissue> tool_in_tissue;
  TissueInTool tissue_in_tool;

  Pose X_WT = Pose::Identity();  ///< the tool's, where samples are taken
  Points start;                  ///< the body at the start of the step
  Box3 swept;                    ///< the tool before and after the step
  double margin = 0.0;           ///< how far the body may move before the selection is too small, m
  BoxSelection selection;

  Parts(const TissueBody& body, const RigidBodyShape& shape, std::unique_ptr<DistanceField> depths,
        const ContactOptions& options)
      : tissue(body), tool(shape), tissue_in_tool(tissue, tool, options, body.isSolid() ? 0.5 : 1.0)
  {
    if (body.isSolid())
    {
      field.emplace(std::move(depths), body.node_count, options.lazy_field);
      tool_in_tissue.emplace(tissue, tool, options);
    }
  }
};

ToolContact::ToolContact(const TissueBody& tissue, const RigidBodyShape& tool,
                         std::unique_ptr<DistanceField> field, const ContactOptions& options)
    : ContactTerm(options, {tissue}),
      parts_(std::make_unique<Parts>(tissue, tool, std::move(field), options))
{}

ToolContact::~ToolContact() = default;

void ToolContact::beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                            bool refresh)
{
  lagFriction(x, X_WT_before, X_WT, refresh);
  lagPlaces(x, X_WT_before, X_WT, refresh);
}

/** Friction of a step is that of the contacts it starts with: where the last one ended, mostly. */
void ToolContact::lagFriction(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                              bool refresh)
{
  if (!friction().acts())
  {
    return;
  }
  if (!haveSamplesAt(x) || parts_->X_WT.matrix() != X_WT_before.matrix())
  {
    lagPlaces(x, X_WT_before, X_WT_before, refresh);
  }
  const std::vector<ContactSample>& touching = samples(x);
  const ScopedTimer timer(times().respond);
  friction().begin(x);
  addGrips(touching, x, X_WT * X_WT_before.inverse(), friction());
}

void ToolContact::lagPlaces(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                            bool refresh)
{
  Parts& p = *parts_;
  {
    const ScopedTimer timer(times().detect);
    takeBodies(x);
    const double last_motion = p.start.empty() ? 0.0 : largestMotion(p.start, body(0));
    p.start = body(0);
    forgetSamples();
    p.X_WT = X_WT;
    p.tissue_in_tool.place(X_WT_before);
    p.swept = p.tissue_in_tool.bounds();
    p.tissue_in_tool.place(X_WT);
    p.swept.extend(p.tissue_in_tool.bounds());
    p.margin =
        kMarginOfRadius * p.tool.innerRadius() + (std::isfinite(last_motion) ? last_motion : 0.0);
    Box3 reach = p.swept;
    reach.grow(p.margin);
    p.selection.clear();
    if (boundsOf(p.start, p.tissue.surface->nodes).overlaps(reach))
    {
      if (p.tool_in_tissue)
      {
        p.tool_in_tissue->place(X_WT);
      }
      select();
    }
  }
  if (p.field)
  {
    p.field->beginStep(p.start, refresh);
    p.field->expect(p.selection.tetNodes());
    times().field += p.field->takeTime();
  }
}

void ToolContact::select()
{
  Parts& p = *parts_;
  Box3 reach = p.swept;
  reach.grow(p.margin);
  p.selection.select(p.start, p.tissue.isSolid() ? *p.tissue.tets : kNoTets, *p.tissue.surface,
                     reach);
  p.tissue_in_tool.lagAreas(p.start, p.selection);
  if (p.field)
  {
    p.field->expect(p.selection.tetNodes());
  }
}

void ToolContact::collect(std::vector<ContactSample>& samples)
{
  Parts& p = *parts_;
  bool hosted = false;
  {
    const ScopedTimer timer(times().detect);
    // The energy stays the same function of x: areas and depths are those of the start whatever
    // the selection, so more elements only add what had been out of reach.
    const double motion = largestMotion(p.start, body(0));
    if (motion > p.margin)
    {
      p.margin = std::isfinite(motion) ? 2.0 * motion : std::numeric_limits<double>::max() / 4.0;
      select();
    }
    hosted = p.tool_in_tissue && p.tool_in_tissue->findHosts(body(0), p.selection.tets());
  }
  Timer timer;
  if (hosted)
  {
    p.tool_in_tissue->addSamples(p.field->ready(), samples);
  }
  p.tissue_in_tool.addSamples(body(0), samples);
  const double marched_s = p.field ? p.field->takeTime() : 0.0;
  times().field += marched_s;
  times().respond += timer.seconds() - marched_s;
}

DepthCurvature ToolContact::curvature(const ContactSample& sample) const
{
  return sample.side > 0 ? parts_->tool_in_tissue->curvature(sample)
                         : parts_->tissue_in_tool.curvature(sample);
}

void ToolContact::setStiffness(double pa_per_m)
{
  if (parts_->tool_in_tissue)
  {
    parts_->tool_in_tissue->setStiffness(pa_per_m);
  }
  parts_->tissue_in_tool.setStiffness(pa_per_m);
}

bool ToolContact::active() const
{
  return !parts_->selection.empty();
}

void ToolContact::exchangePlaces(StateArchive& archive)
{
  Parts& p = *parts_;
  bool any = !p.selection.empty();
  archive.value(p.X_WT);
  archive.list(p.start);
  archive.value(p.swept.min);
  archive.value(p.swept.max);
  archive.value(p.margin);
  archive.value(any);
  if (archive.reading())
  {
    p.tissue_in_tool.place(p.X_WT);
    p.selection.clear();
    if (any)
    {
      if (p.tool_in_tissue)
      {
        p.tool_in_tissue->place(p.X_WT);
      }
      select();
    }
    if (p.field)
    {
      p.field->beginStep(p.start, false);
      p.field->expect(p.selection.tetNodes());
    }
  }
  if (p.field)
  {
    p.field->exchange(archive);
    p.tool_in_tissue->exchange(archive);
  }
}

void ToolContact::forgetPlaces()
{
  if (parts_->field)
  {
    parts_->field->forget();
  }
}

const std::vector<double>& ToolContact::depth() const
{
  return parts_->field ? parts_->field->depth() : kNoDepths;
}

}  // namespace soft_tissue
