#include "soft_tissue_sim/geometry/aabb_tree.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
void AabbTree::build(const std::vector<Box3>& boxes)
{
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    if (!boxes[i].min.allFinite() || !boxes[i].max.allFinite())
    {
      throw Error("AABB tree: box " + std::to_string(i) + " has a coordinate that is not finite");
    }
  }
  item_count_ = boxes.size();
  nodes_.clear();
  nodes_.reserve(2 * boxes.size());
  std::vector<Index> items(boxes.size());
  std::iota(items.begin(), items.end(), 0);
  if (!items.empty())
  {
    buildNode(boxes, items.data(), items.data() + items.size());
  }
}

void AabbTree::buildNode(const std::vector<Box3>& boxes, Index* begin, Index* end)
{
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Box3 box;
  Box3 centres;  // doubled
  for (const Index* item = begin; item != end; ++item)
  {
    box.extend(boxes[*item]);
    centres.extend(boxes[*item].min + boxes[*item].max);
  }
  nodes_[self].box = box;
  if (end - begin == 1)
  {
    nodes_[self].item = *begin;
    return;
  }
  int axis = 0;
  (centres.max - centres.min).maxCoeff(&axis);
  Index* const middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](Index left, Index right) {
    const double left_centre = boxes[left].min[axis] + boxes[left].max[axis];
    const double right_centre = boxes[right].min[axis] + boxes[right].max[axis];
    return left_centre != right_centre ? left_centre < right_centre : left < right;
  });
  buildNode(boxes, begin, middle);
  nodes_[self].right = static_cast<Index>(nodes_.size());
  buildNode(boxes, middle, end);
}

void AabbTree::refit(const std::vector<Box3>& boxes)
{
  if (boxes.size() != item_count_)
  {
    throw Error("AABB tree: refit with " + std::to_string(boxes.size()) +
                " boxes, was built with " + std::to_string(item_count_));
  }
  for (std::size_t i = nodes_.size(); i-- > 0;)
  {
    Node& node = nodes_[i];
    if (node.item >= 0)
    {
      node.box = boxes[node.item];
    }
    else
    {
      node.box = nodes_[i + 1].box;
      node.box.extend(nodes_[node.right].box);
    }
  }
}

}  // namespace soft_tissue
