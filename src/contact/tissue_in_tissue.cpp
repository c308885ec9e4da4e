#include "tissue_in_tissue.h"

#include <utility>

namespace soft_tissue
{
namespace
{
/** Parts of one body don't touch each other where they are nearer than this at rest, in its short
 * edges. */
constexpr double kNeighbours = 0.5;

std::vector<Index> numbersOf(const SurfaceElements& elements, bool edges)
{
  std::vector<Index> numbers;
  for (const SurfaceElement& element : elements.all())
  {
    numbers.insert(numbers.end(), element.nodes.begin(), element.nodes.begin() + (edges ? 2 : 1));
  }
  return numbers;
}

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
      element_nodes_(numbersOf(elements_, options.segments)),
      field_(std::move(host_field), host.node_count, options.lazy_field),
      surface_(host, intruderOf(intruder, side, self), options)
{
  const int each = options.segments ? 2 : 1;
  const ElementSet surface = {element_nodes_.data(), each, static_cast<Index>(elements_.size())};
  const ElementSet tets = {host.tets->data()->data(), 4, static_cast<Index>(host.tets->size())};
  finder_ = makePairFinder(kDefaultPairMethod, surface, tets, self);
  if (self)
  {
    finder_->leaveOut(RestNeighbours(elements_, host));
  }
}

void TissueInTissue::beginStep(const Positions& at, double margin, bool refresh)
{
  at_ = at;
  field_.beginStep(*at_.host, refresh);
  lookAround(margin);
}

void TissueInTissue::lookAround(double margin)
{
  finder_->find(at_.intruder_expected->data(), at_.host_expected->data(), margin, candidates_);
  seen_.assign(elements_.size(), 0);
  for (const ElementPair& pair : candidates_)
  {
    if (seen_[pair.first] == 0)
    {
      seen_[pair.first] = 1;
      elements_.lag(pair.first, *at_.intruder, host_.short_edge);
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
}

bool TissueInTissue::find(const Points& intruder, const Points& host)
{
  return surface_.findHosts(elements_.all(), intruder, host, candidates_);
}

}  // namespace soft_tissue
