#include "tool_in_tissue.h"

#include "soft_tissue_sim/collision/segment_filter.h"

namespace soft_tissue
{
namespace
{
std::vector<SurfaceElement> elementsOf(const ToolSurface& surface, const ContactOptions& options,
                                       double cell)
{
  const bool edges = options.segments;
  std::vector<SurfaceElement> elements;
  for (std::size_t i = 0; edges && i < surface.edges.size(); ++i)
  {
    const Edge& edge = surface.edges[i];
    const double length = (surface.nodes[edge[1]] - surface.nodes[edge[0]]).norm();
    elements.push_back({{edge[0], edge[1]}, surface.edge_area[i], 1.0, cellsOf(length, cell)});
    elements.back().per_area = perArea(options.law, elements.back(), length, Intruder().share);
  }
  for (std::size_t i = 0; !edges && i < surface.nodes.size(); ++i)
  {
    const auto node = static_cast<Index>(i);
    elements.push_back({{node, node}, surface.node_area[i]});
    elements.back().per_area = perArea(options.law, elements.back(), 0.0, Intruder().share);
  }
  return elements;
}
}  // namespace

ToolInTissue::ToolInTissue(const TissueBody& tissue, const RigidBodyShape& tool,
                           const ContactOptions& options)
    : tissue_(tissue), surface_(tissue, Intruder(), options)
{
  ToolSurface surface = sampleToolSurface(tool);
  elements_ = elementsOf(surface, options, tissue.short_edge);
  element_nodes_ = numbersOf(elements_, options.segments);
  numbers_ = elementSet(element_nodes_, options.segments);
  nodes_T_ = std::move(surface.nodes);
  nodes_W_.resize(nodes_T_.size());
  boxes_W_.resize(elements_.size());
}

void ToolInTissue::place(const Pose& X_WT)
{
  for (std::size_t i = 0; i < nodes_T_.size(); ++i)
  {
    nodes_W_[i] = X_WT * nodes_T_[i];
  }
  for (std::size_t i = 0; i < elements_.size(); ++i)
  {
    boxes_W_[i] = Box3();
    boxes_W_[i].extend(nodes_W_[elements_[i].nodes[0]]);
    boxes_W_[i].extend(nodes_W_[elements_[i].nodes[1]]);
  }
  grid_.build(boxes_W_);
}

bool ToolInTissue::findHosts(const Points& x, const std::vector<Index>& tets)
{
  candidates_.clear();
  for (const Index t : tets)
  {
    Box3 box;
    for (const Index node : (*tissue_.tets)[t])
    {
      box.extend(x[node]);
    }
    grid_.forEachOverlap(box, [&](Index element) { candidates_.push_back({element, t}); });
  }
  dropParted(numbers_, nodes_W_.data(), tetsOf(tissue_), x.data(), 0.0, candidates_);
  return surface_.findHosts(elements_, numbers_, nodes_W_, x, candidates_);
}

}  // namespace soft_tissue
