#pragma once

#include <limits>
#include <optional>

namespace soft_tissue
{
/** The wall time that a step has, and its parts of that: what a part leaves is shared by those
 * after it, and none takes what they need. Times are counted from the step's beginning. */
class StepBudget
{
 public:
  /** @param whole_s  empty: as much as it takes */
  void begin(std::optional<double> whole_s)
  {
    end_s_ = whole_s.value_or(std::numeric_limits<double>::infinity());
    part_end_s_ = end_s_;
  }

  /** The part [from, to] of the step, 0 <= from < to <= 1, begins at now_s. */
  void beginPart(double from, double to, double now_s)
  {
    part_end_s_ = now_s + (end_s_ - now_s) * (to - from) / (1.0 - from);
  }

  /** What the part has left, s; not above 0 where it is over. */
  double left(double now_s) const { return part_end_s_ - now_s; }

 private:
  double end_s_ = std::numeric_limits<double>::infinity();
  double part_end_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace soft_tissue
