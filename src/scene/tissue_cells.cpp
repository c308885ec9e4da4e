#include "soft_tissue_sim/scene/tissue_cells.h"

#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/cell_cover.h"

namespace soft_tissue
{
namespace
{
/** Cells in the boxes around all tissues; deformation makes them somewhat more. */
constexpr double kMostCells = 1 << 24;
}  // namespace

TissueCells::TissueCells(const SceneConfig& config, const std::vector<TissueInfo>& tissues)
    : tissues_(tissues),
      occupied_(config.outputs.octomap->resolution_m),
      seen_(config.outputs.octomap->resolution_m)
{
  double count = 0.0;
  for (const TissueInfo& tissue : tissues)
  {
    const Box3 box = boundsOf(tissue.rest.nodes);
    count += ((box.max - box.min) / occupied_.cellSize()).array().ceil().max(1.0).prod();
  }
  if (count > kMostCells)
  {
    std::ostringstream text;
    text << "scene " << config.file << ": outputs.octomap.resolution_m = " << occupied_.cellSize()
         << ": boxes around the tissues have " << count << " such cells, must be at most "
         << kMostCells;
    throw Error(text.str());
  }
}

void TissueCells::update(const Snapshot& snapshot)
{
  occupied_ = VoxelSet(occupied_.cellSize());
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const Points& x = snapshot.tissues[k].positions;
    for (const Tet& t : tissues_[k].rest.tets)
    {
      coverTet({x[t[0]], x[t[1]], x[t[2]], x[t[3]]}, occupied_);
    }
    if (tissues_[k].isMembrane())
    {
      for (const Triangle& t : tissues_[k].surface.triangles)
      {
        coverTriangle({x[t[0]], x[t[1]], x[t[2]]}, occupied_);
      }
    }
  }
  occupied_.forEachOther([&](const Cell& cell) { seen_.set(cell, true); });
}

}  // namespace soft_tissue
