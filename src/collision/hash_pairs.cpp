#include "group_pairs.h"
#include "pair_methods.h"
#include "soft_tissue_sim/collision/box_grid.h"

namespace soft_tissue
{
namespace
{
/** Puts the second set's elements in voxels and asks for those around each of the first. */
class HashPairs : public GroupPairs
{
 public:
  using GroupPairs::GroupPairs;

 protected:
  void search() override
  {
    places_.clear();
    boxes_.clear();
    forEachThere(second_, first_, [&](Index place) {
      const double* const v = second_.box(place).v;
      Box3 box;
      box.min = {v[3], v[4], v[5]};
      box.max = {-v[0], -v[1], -v[2]};
      places_.push_back(place);
      boxes_.push_back(box);
    });
    grid_.build(boxes_);
    forEachThere(first_, second_, [&](Index place) {
      const double* const v = first_.box(place).v;
      Box3 box;
      box.min = {v[0], v[1], v[2]};
      box.max = {-v[3], -v[4], -v[5]};
      grid_.forEachOverlap(box, [&](Index i) { add(place, places_[i]); });
    });
  }

 private:
  /** Visits the elements of a set that are inside the bounds of the other one, opened. */
  template <typename Visit>
  void forEachThere(ElementGroups& own, const ElementGroups& other, const Visit& visit)
  {
    const BoxEnds& all = other.level(other.levels() - 1)[0];
    for (Index group = 0; group < static_cast<Index>(own.level(0).size()); ++group)
    {
      if (overlap(own.level(0)[group], all, slack_))
      {
        own.open(group);
        for (Index place = own.begin(group); place < own.end(group); ++place)
        {
          if (overlap(own.box(place), other.bounds()))
          {
            visit(place);
          }
        }
      }
    }
  }

  std::vector<Index> places_;  ///< of the boxes in the voxels
  std::vector<Box3> boxes_;
  BoxGrid grid_;
};
}  // namespace

std::unique_ptr<PairFinder> makeHashPairs(const ElementSet& first, const ElementSet& second,
                                          bool one_body)
{
  return std::make_unique<HashPairs>(first, second, one_body);
}

}  // namespace soft_tissue
