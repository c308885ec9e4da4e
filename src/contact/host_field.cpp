#include "host_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue
{
HostField::HostField(std::unique_ptr<DistanceField> field, Index node_count, bool lazy)
    : field_(std::move(field)),
      no_depth_(node_count, std::numeric_limits<double>::quiet_NaN()),
      lazy_(lazy)
{}

void HostField::beginStep(const Points& start, bool refresh)
{
  start_ = &start;
  refresh_ = refresh || forgotten_;
  checked_ = false;
  if (refresh && !lazy_)
  {
    const ScopedTimer timer(seconds_);
    field_->march(start);
    refresh_ = forgotten_ = false;
  }
}

void HostField::expect(const std::vector<Index>& nodes)
{
  nodes_ = nodes;
  checked_ = false;
}

const DistanceField& HostField::ready()
{
  if (checked_)
  {
    return *field_;
  }
  const std::vector<double>& known = depth();
  const bool complete = std::all_of(nodes_.begin(), nodes_.end(),
                                    [&](Index node) { return !std::isnan(known[node]); });
  if (refresh_ || !complete)
  {
    const ScopedTimer timer(seconds_);
    field_->marchUntil(*start_, nodes_);
    forgotten_ = false;
  }
  refresh_ = false;
  checked_ = true;
  return *field_;
}

const std::vector<double>& HostField::depth() const
{
  return field_->depth().size() == no_depth_.size() ? field_->depth() : no_depth_;
}

void HostField::exchange(StateArchive& archive)
{
  archive.value(refresh_);
  archive.value(forgotten_);
  archive.value(checked_);
  field_->exchange(archive);
}

double HostField::takeTime()
{
  return std::exchange(seconds_, 0.0);
}

}  // namespace soft_tissue
