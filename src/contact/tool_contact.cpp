#include "soft_tissue_sim/contact/tool_contact.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "friction.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/contact/sample_sums.h"
#include "tissue_in_tool.h"
#include "tool_in_tissue.h"

namespace soft_tissue
{
namespace
{
/** Largest distance any point has moved, m; infinite when that can't be told. */
double largestMotion(const Points& from, const Points& to)
{
  double squared = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    const double moved = (to[i] - from[i]).squaredNorm();
    if (!(moved <= squared))
    {
      squared = moved;
    }
    if (std::isnan(squared))
    {
      return std::numeric_limits<double>::infinity();
    }
  }
  return std::sqrt(squared);
}

Box3 boundsOf(const Points& x, const std::vector<Index>& nodes)
{
  Box3 box;
  for (const Index node : nodes)
  {
    box.extend(x[node]);
  }
  return box;
}
}  // namespace

class ToolContact::Impl
{
 public:
  Impl(const TissueBody& tissue, const RigidBodyShape& tool, std::unique_ptr<DistanceField> field,
       const ToolContactOptions& options)
      : tissue_(tissue),
        options_(options),
        field_(std::move(field)),
        no_depth_(tissue.node_count, std::numeric_limits<double>::quiet_NaN()),
        tool_(tool),
        tool_in_tissue_(tissue, tool_, options),
        tissue_in_tool_(tissue, tool_, options),
        friction_(options.friction)
  {}

  void lagFriction(const Points& x, const Pose& X_WT_before, const Pose& X_WT, double step_s,
                   bool refresh);
  void beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT, bool refresh);
  void forgetField() { field_forgotten_ = true; }
  void setStiffening(double factor);
  double stiffening() const { return stiffening_; }
  bool active() const { return !selection_.empty(); }
  Friction& friction() { return friction_; }
  const std::vector<ContactSample>& samplesAt(const Points& x);
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian);
  const std::vector<double>& depth() const;
  ContactTimes takeTimes() { return std::exchange(times_, ContactTimes()); }

 private:
  bool haveSamplesAt(const Points& x) const;
  void select();
  void widenTo(double motion);
  void ensureField();
  void collect();
  const Vec3* bodyIn(const Points& x) const { return x.data() + tissue_.first_node; }

  TissueBody tissue_;
  ToolContactOptions options_;
  std::unique_ptr<DistanceField> field_;
  std::vector<double> no_depth_;
  RigidBodyShape tool_;
  ToolInTissue tool_in_tissue_;
  TissueInTool tissue_in_tool_;
  Friction friction_;
  double stiffening_ = 1.0;

  Pose X_WT_ = Pose::Identity();  ///< the tool's, where samples_ were taken
  Points start_;                  ///< the body at the start of the step
  Box3 swept_;                    ///< the tool before and after the step
  double margin_ = 0.0;  ///< how far the body may move before the selection is too small, m
  BoxSelection selection_;
  bool refresh_field_ = false;    ///< march anew before the field is read
  bool field_forgotten_ = false;  ///< and so in the next steps, until that is done
  bool field_checked_ = false;    ///< all nodes of the selection are known to have their depth

  Points body_;  ///< the body where samples_ were taken
  bool have_samples_ = false;
  std::vector<ContactSample> samples_;
  ContactTimes times_;
};

/** Friction of a step is that of the contacts it starts with: where the last one ended, mostly. */
void ToolContact::Impl::lagFriction(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                                    double step_s, bool refresh)
{
  if (!friction_.acts())
  {
    return;
  }
  if (!haveSamplesAt(x) || X_WT_.matrix() != X_WT_before.matrix())
  {
    beginStep(x, X_WT_before, X_WT_before, refresh);
  }
  const std::vector<ContactSample>& touching = samplesAt(x);
  const ScopedTimer timer(times_.respond);
  friction_.lag(touching, x, X_WT_before, X_WT, step_s);
}

void ToolContact::Impl::beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                                  bool refresh)
{
  Timer timer;
  constexpr double kMarginOfRadius = 0.5;
  body_.assign(bodyIn(x), bodyIn(x) + tissue_.node_count);
  const double last_motion = start_.empty() ? 0.0 : largestMotion(start_, body_);
  start_.swap(body_);
  body_.resize(start_.size());
  have_samples_ = false;
  samples_.clear();

  X_WT_ = X_WT;
  tissue_in_tool_.place(X_WT_before);
  swept_ = tissue_in_tool_.bounds();
  tissue_in_tool_.place(X_WT);
  swept_.extend(tissue_in_tool_.bounds());
  // Half a radius and what the body moved last step; more is met by widenTo().
  margin_ =
      kMarginOfRadius * tool_.innerRadius() + (std::isfinite(last_motion) ? last_motion : 0.0);
  refresh_field_ = refresh || field_forgotten_;
  Box3 reach = swept_;
  reach.grow(margin_);
  selection_.clear();
  if (boundsOf(start_, tissue_.surface->nodes).overlaps(reach))
  {
    tool_in_tissue_.place(X_WT);
    select();
  }
  times_.detect += timer.restart();
  if (refresh && !options_.lazy_field)
  {
    field_->march(start_);
    refresh_field_ = field_forgotten_ = false;
    times_.field += timer.seconds();
  }
}

void ToolContact::Impl::setStiffening(double factor)
{
  have_samples_ = have_samples_ && factor == stiffening_;
  stiffening_ = factor;
  tool_in_tissue_.setStiffness(factor * options_.stiffness_pa_per_m);
  tissue_in_tool_.setStiffness(factor * options_.stiffness_pa_per_m);
}

void ToolContact::Impl::select()
{
  Box3 reach = swept_;
  reach.grow(margin_);
  selection_.select(start_, *tissue_.tets, *tissue_.surface, reach);
  tissue_in_tool_.lagAreas(start_, selection_);
  field_checked_ = false;
}

// The energy stays the same function of x: areas and depths are those of the start whatever the
// selection, so more elements only add what had been out of reach.
void ToolContact::Impl::widenTo(double motion)
{
  margin_ = std::isfinite(motion) ? 2.0 * motion : std::numeric_limits<double>::max() / 4.0;
  select();
}

void ToolContact::Impl::ensureField()
{
  const std::vector<double>& known = depth();
  const bool complete = std::all_of(selection_.tetNodes().begin(), selection_.tetNodes().end(),
                                    [&](Index node) { return !std::isnan(known[node]); });
  if (refresh_field_ || !complete)
  {
    const ScopedTimer timer(times_.field);
    field_->marchUntil(start_, selection_.tetNodes());
    field_forgotten_ = false;
  }
  refresh_field_ = false;
  field_checked_ = true;
}

bool ToolContact::Impl::haveSamplesAt(const Points& x) const
{
  const std::size_t bytes = body_.size() * sizeof(Vec3);
  return have_samples_ && std::memcmp(body_.data(), bodyIn(x), bytes) == 0;
}

const std::vector<ContactSample>& ToolContact::Impl::samplesAt(const Points& x)
{
  if (!active() || haveSamplesAt(x))
  {
    return samples_;
  }
  std::copy(bodyIn(x), bodyIn(x) + tissue_.node_count, body_.begin());
  samples_.clear();
  collect();
  have_samples_ = true;
  return samples_;
}

void ToolContact::Impl::collect()
{
  Timer timer;
  const double motion = largestMotion(start_, body_);
  if (motion > margin_)
  {
    widenTo(motion);
  }
  const bool hosted = tool_in_tissue_.findHosts(body_, selection_.tets());
  times_.detect += timer.restart();
  if (hosted && !field_checked_)
  {
    ensureField();
    timer.restart();
  }
  if (hosted)
  {
    tool_in_tissue_.addSamples(body_, *field_, samples_);
  }
  tissue_in_tool_.addSamples(body_, samples_);
  times_.respond += timer.seconds();
}

// Clip points are left out: what they add is what the quadrature is off, and small.
void ToolContact::Impl::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  for (const ContactSample& sample : samplesAt(x))
  {
    if (sample.stiffness_area == 0.0)
    {
      continue;
    }
    if (curvature == Curvature::positive)
    {
      addLinearStiffness(sample, hessian);
      continue;
    }
    addStiffness(sample,
                 sample.tool_sign > 0 ? tool_in_tissue_.curvature(sample, body_)
                                      : tissue_in_tool_.curvature(sample),
                 hessian);
  }
}

const std::vector<double>& ToolContact::Impl::depth() const
{
  return field_->depth().size() == no_depth_.size() ? field_->depth() : no_depth_;
}

ToolContact::ToolContact(const TissueBody& tissue, const RigidBodyShape& tool,
                         std::unique_ptr<DistanceField> field, const ToolContactOptions& options)
    : impl_(std::make_unique<Impl>(tissue, tool, std::move(field), options))
{}

ToolContact::~ToolContact() = default;

void ToolContact::beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT,
                            double step_s, bool refresh)
{
  impl_->lagFriction(x, X_WT_before, X_WT, step_s, refresh);
  impl_->beginStep(x, X_WT_before, X_WT, refresh);
}

void ToolContact::forgetField()
{
  impl_->forgetField();
}

void ToolContact::setStiffening(double factor)
{
  impl_->setStiffening(factor);
}

double ToolContact::stiffening() const
{
  return impl_->stiffening();
}

double ToolContact::deepest(const Points& x)
{
  double deepest = 0.0;
  for (const ContactSample& sample : impl_->samplesAt(x))
  {
    deepest = std::max(deepest, sample.depth);
  }
  return deepest;
}

bool ToolContact::active() const
{
  return impl_->active();
}

double ToolContact::value(const Points& x)
{
  return contactEnergy(impl_->samplesAt(x)) + impl_->friction().value(x);
}

void ToolContact::addGradient(const Points& x, Points& gradient)
{
  addContactGradient(impl_->samplesAt(x), gradient);
  impl_->friction().addGradient(x, gradient);
}

void ToolContact::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  impl_->addHessian(x, curvature, hessian);
  impl_->friction().addHessian(x, hessian);
}

const std::vector<ContactSample>& ToolContact::samples(const Points& x)
{
  return impl_->samplesAt(x);
}

const std::vector<FrictionForce>& ToolContact::frictionForces(const Points& x)
{
  return impl_->friction().forcesAt(x);
}

const std::vector<double>& ToolContact::depth() const
{
  return impl_->depth();
}

ContactTimes ToolContact::takeTimes()
{
  return impl_->takeTimes();
}

}  // namespace soft_tissue
