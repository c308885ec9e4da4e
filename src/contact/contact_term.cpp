#include "soft_tissue_sim/contact/contact_term.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "friction.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "soft_tissue_sim/contact/sample_sums.h"

namespace soft_tissue
{
ContactTerm::ContactTerm(const ContactOptions& options, const std::vector<TissueBody>& bodies)
    : options_(options),
      bodies_(bodies),
      nodes_(bodies.size()),
      points_(bodies.size()),
      friction_(std::make_unique<Friction>(options.friction, options.damping_s_per_m))
{}

ContactTerm::~ContactTerm() = default;

void ContactTerm::takeBodies(const Points& x)
{
  for (std::size_t k = 0; k < bodies_.size(); ++k)
  {
    const auto first = x.begin() + bodies_[k].first_node;
    nodes_[k].assign(first, first + bodies_[k].node_count);
    if (bodies_[k].points != nullptr)
    {
      placePoints(*bodies_[k].points, nodes_[k], points_[k]);
    }
  }
}

bool ContactTerm::haveSamplesAt(const Points& x) const
{
  bool same = have_samples_;
  for (std::size_t k = 0; k < bodies_.size() && same; ++k)
  {
    same = std::memcmp(nodes_[k].data(), x.data() + bodies_[k].first_node,
                       nodes_[k].size() * sizeof(Vec3)) == 0;
  }
  return same;
}

void ContactTerm::forgetSamples()
{
  have_samples_ = false;
  samples_.clear();
}

const std::vector<ContactSample>& ContactTerm::samples(const Points& x)
{
  if (active() && !haveSamplesAt(x))
  {
    takeBodies(x);
    samples_.clear();
    collect(samples_);
    have_samples_ = true;
  }
  return samples_;
}

double ContactTerm::value(const Points& x)
{
  return contactEnergy(samples(x)) + friction_->value(x);
}

void ContactTerm::addGradient(const Points& x, Points& gradient)
{
  addContactGradient(samples(x), gradient);
  friction_->addGradient(x, gradient);
}

// Clip points are left out: what they add is what the quadrature is off, and small.
void ContactTerm::addHessian(const Points& x, Curvature kind, BlockMatrix& hessian)
{
  for (const ContactSample& sample : samples(x))
  {
    if (sample.stiffness_area == 0.0)
    {
      continue;
    }
    if (kind == Curvature::positive)
    {
      addLinearStiffness(sample, hessian);
    }
    else
    {
      addStiffness(sample, curvature(sample), hessian);
    }
  }
  friction_->addHessian(x, hessian);
}

void ContactTerm::setStep(double step_s)
{
  friction_->setStep(step_s);
}

void ContactTerm::setBaseStiffness(double pa_per_m)
{
  if (pa_per_m != options_.stiffness_pa_per_m)
  {
    options_.stiffness_pa_per_m = pa_per_m;
    forgetSamples();
    setStiffening(stiffening_);
  }
}

void ContactTerm::setStiffening(double factor)
{
  have_samples_ = have_samples_ && factor == stiffening_;
  stiffening_ = factor;
  setStiffness(factor * options_.stiffness_pa_per_m);
}

void ContactTerm::forget()
{
  forgetPlaces();
  setStiffening(1.0);
  friction_->forget();
}

double ContactTerm::deepest(const Points& x)
{
  double deepest = 0.0;
  for (const ContactSample& sample : samples(x))
  {
    deepest = std::max(deepest, sample.depth);
  }
  return deepest;
}

double ContactTerm::deepestExcess(const Points& x)
{
  double deepest = 0.0;
  for (const ContactSample& sample : samples(x))
  {
    deepest = std::max(deepest, sample.excess());
  }
  return deepest;
}

void ContactTerm::addTo(StateHash& hash) const
{
  hash.addValue(stiffening_);
  friction_->addTo(hash);
}

void ContactTerm::exchange(StateArchive& archive, const Points& x)
{
  double factor = stiffening_;
  archive.value(factor);
  friction_->exchange(archive);
  bool sampled = haveSamplesAt(x);
  archive.value(sampled);
  if (archive.reading())
  {
    forgetSamples();
    setStiffening(factor);
  }
  exchangePlaces(archive);
  if (archive.reading() && sampled)
  {
    samples(x);
  }
}

const std::vector<FrictionForce>& ContactTerm::frictionForces(const Points& x)
{
  return friction_->forcesAt(x);
}

ContactTimes ContactTerm::takeTimes()
{
  return std::exchange(times_, ContactTimes());
}

}  // namespace soft_tissue
