#include "tissue_in_tissue.h"

#include <algorithm>
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
      surface_(host, intruderOf(intruder, side, self), options),
      is_self_(self)
{
  if (self)
  {
    takeRestBoxes(*host.rest);
  }
  const int each = options.segments ? 2 : 1;
  const ElementSet surface = {element_nodes_.data(), each, static_cast<Index>(elements_.size())};
  const ElementSet tets = {host.tets->data()->data(), 4, static_cast<Index>(host.tets->size())};
  finder_ = makePairFinder(kDefaultPairMethod, surface, tets, self);
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
  if (is_self_)
  {
    dropNeighbours();
  }
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

void TissueInTissue::takeRestBoxes(const Points& rest)
{
  for (Index element = 0; element < static_cast<Index>(elements_.size()); ++element)
  {
    Box3 box;
    for (const Index node : elements_.nodes(element))
    {
      box.extend(rest[node]);
    }
    box.grow(kNeighbours * host_.short_edge);
    element_boxes_.push_back(box);
  }
  for (const Tet& tet : *host_.tets)
  {
    Box3 box;
    for (const Index node : tet)
    {
      box.extend(rest[node]);
    }
    tet_boxes_.push_back(box);
  }
}

/** What is side by side at rest stays so, and is most of what is near in a body. */
void TissueInTissue::dropNeighbours()
{
  const auto areNeighbours = [&](const ElementPair& pair) {
    return element_boxes_[pair.first].overlaps(tet_boxes_[pair.second]);
  };
  candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(), areNeighbours),
                    candidates_.end());
}

bool TissueInTissue::find(const Points& intruder, const Points& host)
{
  return surface_.findHosts(elements_.all(), intruder, host, candidates_);
}

}  // namespace soft_tissue
