#include "soft_tissue_sim/energy/tet_chunks.h"

#include <algorithm>

#include "coloured_chunks.h"
#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/geometry/halving_order.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
/** How often a body is halved that has so many groups of lanes. */
constexpr int kHalvings = 3;
constexpr Index kFewestGroups = 192;
/** Groups of lanes in a chunk of what is left. */
constexpr Index kGroupsEach = 4;

using Tets = std::vector<Index>;

/** Tets along a Morton curve through their centres. */
Tets nearbyOrder(const TetMesh& mesh)
{
  Points centres;
  centres.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets)
  {
    Vec3 centre = Vec3::Zero();
    for (const Index node : tet)
    {
      centre += 0.25 * mesh.nodes[node];
    }
    centres.push_back(centre);
  }
  return mortonOrder(centres);
}

/** The smallest part of a body that has all of a tet. */
struct Home
{
  int halvings = 0;
  int part = 0;  ///< of the 2^halvings there are then

  bool operator==(const Home& other) const
  {
    return halvings == other.halvings && part == other.part;
  }
  /** Small parts come first. */
  bool operator<(const Home& other) const
  {
    return halvings != other.halvings ? halvings > other.halvings : part < other.part;
  }
};

std::vector<Home> homesOf(const TetMesh& mesh)
{
  const std::vector<int> parts = halvedParts(mesh.nodes, kHalvings);
  std::vector<Home> homes;
  homes.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets)
  {
    Home home = {kHalvings, parts[tet[0]]};
    for (const Index node : tet)
    {
      while (parts[node] >> (kHalvings - home.halvings) != home.part)
      {
        --home.halvings;
        home.part >>= 1;
      }
    }
    homes.push_back(home);
  }
  return homes;
}

void addChunk(Tets::const_iterator begin, Tets::const_iterator end, TetChunks& chunks)
{
  chunks.tets.insert(chunks.tets.end(), begin, end);
  chunks.tets.resize((chunks.tets.size() + kTetLanes - 1) / kTetLanes * kTetLanes, -1);
  chunks.groups.push_back(static_cast<Index>(chunks.tets.size()) / kTetLanes);
}

void endColour(TetChunks& chunks)
{
  chunks.colours.push_back(static_cast<Index>(chunks.groups.size()) - 1);
}

/** Adds the tets of all parts, one chunk for each part. @return those between the halves */
Tets addParts(const TetMesh& mesh, Tets tets, TetChunks& chunks)
{
  const std::vector<Home> homes = homesOf(mesh);
  std::stable_sort(tets.begin(), tets.end(), [&](Index a, Index b) { return homes[a] < homes[b]; });
  auto begin = tets.cbegin();
  for (Home home = {kHalvings, 0}; home.halvings > 0; --home.halvings)
  {
    for (home.part = 0; home.part < 1 << home.halvings; ++home.part)
    {
      const auto end =
          std::find_if(begin, tets.cend(), [&](Index t) { return !(homes[t] == home); });
      addChunk(begin, end, chunks);
      begin = end;
    }
    endColour(chunks);
  }
  return Tets(begin, tets.cend());
}
}  // namespace

TetChunks chunkTets(const TetMesh& mesh)
{
  TetChunks chunks;
  chunks.groups.push_back(0);
  chunks.colours.push_back(0);
  Tets tets = nearbyOrder(mesh);
  if (static_cast<Index>(tets.size()) >= kFewestGroups * kTetLanes)
  {
    tets = addParts(mesh, std::move(tets), chunks);
  }
  const std::size_t size = static_cast<std::size_t>(kGroupsEach) * kTetLanes;
  const std::vector<int> colours = colourChunks(mesh.nodes.size(), mesh.tets, tets, size);
  const int count = colours.empty() ? 0 : 1 + *std::max_element(colours.begin(), colours.end());
  for (int colour = 0; colour < count; ++colour)
  {
    for (std::size_t chunk = 0; chunk < colours.size(); ++chunk)
    {
      if (colours[chunk] == colour)
      {
        const std::size_t first = chunk * size;
        addChunk(tets.cbegin() + first, tets.cbegin() + std::min(first + size, tets.size()),
                 chunks);
      }
    }
    endColour(chunks);
  }
  return chunks;
}

}  // namespace soft_tissue
