#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * Binary min-heap of mesh nodes whose keys can be decreased in place: each node knows where it
 * stands.
 *
 * Equal keys come out in the order of node numbers. All memory is taken at construction.
 */
class NodeHeap
{
 public:
  explicit NodeHeap(Index node_count) : place_(node_count, -1) { entries_.reserve(node_count); }

  bool empty() const { return entries_.empty(); }

  /** Puts a node in, or moves it forward; its key must not be above the one it has. */
  void pushOrDecrease(Index node, double key)
  {
    Index place = place_[node];
    if (place < 0)
    {
      place = static_cast<Index>(entries_.size());
      entries_.push_back({key, node});
    }
    siftUp(place, {key, node});
  }

  /** Takes out the node of least key. */
  Index pop()
  {
    const Index node = entries_.front().node;
    place_[node] = -1;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (!entries_.empty())
    {
      siftDown(last);
    }
    return node;
  }

  /** Drops all nodes that are still in, in time proportional to their number. */
  void clear()
  {
    for (const Entry& entry : entries_)
    {
      place_[entry.node] = -1;
    }
    entries_.clear();
  }

 private:
  struct Entry
  {
    double key;
    Index node;
    bool operator<(const Entry& other) const
    {
      return key != other.key ? key < other.key : node < other.node;
    }
  };

  void put(Index place, const Entry& entry)
  {
    entries_[place] = entry;
    place_[entry.node] = place;
  }

  void siftUp(Index place, const Entry& entry)
  {
    while (place > 0 && entry < entries_[(place - 1) / 2])
    {
      put(place, entries_[(place - 1) / 2]);
      place = (place - 1) / 2;
    }
    put(place, entry);
  }

  void siftDown(const Entry& entry)
  {
    const Index size = static_cast<Index>(entries_.size());
    Index place = 0;
    for (Index child = 1; child < size; child = 2 * place + 1)
    {
      if (child + 1 < size && entries_[child + 1] < entries_[child])
      {
        ++child;
      }
      if (!(entries_[child] < entry))
      {
        break;
      }
      put(place, entries_[child]);
      place = child;
    }
    put(place, entry);
  }

  std::vector<Entry> entries_;
  std::vector<Index> place_;  ///< per node: in entries_, -1 outside
};

}  // namespace soft_tissue
