#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
/** The nodal depths of a tissue that others intrude into, marched no further than asked for. */
class HostField
{
 public:
  /** @param lazy  march only as far as depths are read, and only when they are */
  HostField(std::unique_ptr<DistanceField> field, Index node_count, bool lazy);

  /**
   * A step begins.
   * @param start    positions of the body, m; they stay until the next step
   * @param refresh  march anew on them; false keeps the depths there are and marches only where a
   *                 node is read that has none yet
   */
  void beginStep(const Points& start, bool refresh);

  /** Has depths marched anew before they are next read, whatever beginStep() is told. */
  void forget() { forgotten_ = true; }

  /** Says which nodes may be read from now on in this step. */
  void expect(const std::vector<Index>& nodes);

  /** The field with depths on all those nodes. */
  const DistanceField& ready();

  /** Nodal depths of the last march; all NaN before the first. */
  const std::vector<double>& depth() const;

  /** Writes, or reads into one that has just begun the same step, what it has found. */
  void exchange(StateArchive& archive);

  /** Wall time of marches since the last call, s. */
  double takeTime();

 private:
  std::unique_ptr<DistanceField> field_;
  std::vector<double> no_depth_;
  bool lazy_;
  const Points* start_ = nullptr;
  std::vector<Index> nodes_;
  bool refresh_ = false;    ///< march anew before the field is read
  bool forgotten_ = false;  ///< and so in the next steps, until that is done
  bool checked_ = false;    ///< all expected nodes are known to have their depth
  double seconds_ = 0.0;
};

}  // namespace soft_tissue
