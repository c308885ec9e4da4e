#include "tissue_in_tissue.h"

#include <utility>

#include "soft_tissue_sim/collision/segment_filter.h"

namespace soft_tissue
{
namespace
{
/** Parts of one body don't touch each other where they are nearer than this at rest, in its short
 * edges. */
constexpr double kNeighbours = 0.5;

/** Of the intruder's area, see Intruder. */
double shareOf(const TissueBody& intruder)
{
  return intruder.isSolid() ? 0.5 : 1.0;
}

/** Elements and tets of one body that are side by side at rest: they stay so, and are most of what
 * is near in a body. */
class RestNeighbours
{
 public:
  RestNeighbours(const SurfaceElements& elements, const TissueBody& body)
  {
    for (Index element = 0; element < static_cast<Index>(elements.size()); ++element)
    {
      element_boxes_.push_back(boxOf(elements.nodes(element), *body.rest));
      element_boxes_.back().grow(kNeighbours * body.short_edge);
    }
    for (const Tet& tet : *body.tets)
    {
      tet_boxes_.push_back(boxOf(tet, *body.rest));
    }
  }

  bool operator()(const ElementPair& pair) const
  {
    return element_boxes_[pair.first].overlaps(tet_boxes_[pair.second]);
  }

 private:
  template <typename Nodes>
  static Box3 boxOf(const Nodes& nodes, const Points& rest)
  {
    Box3 box;
    for (const Index node : nodes)
    {
      box.extend(rest[node]);
    }
    return box;
  }

  std::vector<Box3> element_boxes_;  ///< grown by how near neighbours are
  std::vector<Box3> tet_boxes_;
};

Intruder intruderOf(const TissueBody& body, int side, bool self)
{
  Intruder intruder;
  intruder.side = side;
  intruder.share = shareOf(body);
  intruder.body = body;
  intruder.rest = self ? body.rest : nullptr;
  return intruder;
}
}  // namespace

TissueInTissue::TissueInTissue(const TissueBody& intruder, const TissueBody& host,
                               std::unique_ptr<DistanceField> host_field, int side, bool self,
                               const ContactOptions& options)
    : host_(host),
      elements_(*intruder.surface, options, shareOf(intruder)),
      element_nodes_(numbersOf(elements_.all(), options.segments)),
      field_(std::move(host_field), host.node_count, options.lazy_field),
      surface_(host, intruderOf(intruder, side, self), options)
{
  numbers_ = elementSet(element_nodes_, options.segments);
  finder_ = makePairFinder(kDefaultPairMethod, numbers_, tetsOf(host), self);
  if (self)
  {
    finder_->leaveOut(RestNeighbours(elements_, host));
  }
}

void TissueInTissue::beginStep(const Positions& start, bool refresh)
{
  start_ = start;
  field_.beginStep(*start_.host, refresh);
  lagElements();
}

void TissueInTissue::lookAround(const Positions& at, double margin)
{
  const Vec3 *intruder = at.intruder->data(), *host = at.host->data();
  finder_->find(intruder, host, margin, candidates_);
  dropParted(numbers_, intruder, tetsOf(host_), host, margin, candidates_);
  near_elements_.clear();
  seen_.assign(elements_.size(), 0);
  for (const ElementPair& pair : candidates_)
  {
    if (seen_[pair.first] == 0)
    {
      seen_[pair.first] = 1;
      near_elements_.push_back(pair.first);
    }
  }
  host_nodes_.clear();
  seen_.assign(host_.node_count, 0);
  for (const ElementPair& pair : candidates_)
  {
    for (const Index node : (*host_.tets)[pair.second])
    {
      if (seen_[node] == 0)
      {
        seen_[node] = 1;
        host_nodes_.push_back(node);
      }
    }
  }
  field_.expect(host_nodes_);
  lagElements();
}

void TissueInTissue::lagElements()
{
  for (const Index element : near_elements_)
  {
    elements_.lag(element, *start_.intruder, host_.short_edge);
  }
}

bool TissueInTissue::find(const Points& intruder, const Points& host)
{
  return surface_.findHosts(elements_.all(), numbers_, intruder, host, candidates_);
}

}  // namespace soft_tissue
