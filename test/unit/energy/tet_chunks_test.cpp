#include "soft_tissue_sim/energy/tet_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue
{
namespace
{
/** Tets of each chunk, colour by colour. */
std::vector<std::vector<std::vector<Index>>> tetsByColour(const TetChunks& chunks)
{
  std::vector<std::vector<std::vector<Index>>> colours;
  for (std::size_t colour = 0; colour + 1 < chunks.colours.size(); ++colour)
  {
    colours.emplace_back();
    for (Index chunk = chunks.colours[colour]; chunk < chunks.colours[colour + 1]; ++chunk)
    {
      colours.back().emplace_back();
      for (Index lane = kTetLanes * chunks.groups[chunk];
           lane < kTetLanes * chunks.groups[chunk + 1]; ++lane)
      {
        if (chunks.tets[lane] >= 0)
        {
          colours.back().back().push_back(chunks.tets[lane]);
        }
      }
    }
  }
  return colours;
}
}  // namespace

TEST(TetChunks, OfOneColourShareNoNodeAndAllHaveEveryTetOnce)
{
  for (const TetMesh& mesh : {TetMesh(), makeBox({1, 1, 1}, {1.0, 1.0, 1.0}), makeBall(1.0, 1200),
                              makeBall(1.0, 6000), makeBox({40, 6, 6}, {0.2, 0.03, 0.03})})
  {
    std::vector<int> seen(mesh.tets.size(), 0);
    for (const auto& colour : tetsByColour(chunkTets(mesh)))
    {
      std::vector<Index> chunk_of(mesh.nodes.size(), -1);
      for (std::size_t chunk = 0; chunk < colour.size(); ++chunk)
      {
        for (const Index tet : colour[chunk])
        {
          ++seen[tet];
          for (const Index node : mesh.tets[tet])
          {
            EXPECT_TRUE(chunk_of[node] < 0 || chunk_of[node] == static_cast<Index>(chunk));
            chunk_of[node] = static_cast<Index>(chunk);
          }
        }
      }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  }
}

// Most work is in eight parts that can be done at once, and neither of two threads has much more
// of it than the other.
TEST(TetChunks, OfALongBodyAreMostlyItsParts)
{
  const TetMesh mesh = makeBox({40, 6, 6}, {0.2, 0.03, 0.03});
  const auto colours = tetsByColour(chunkTets(mesh));
  ASSERT_EQ(colours[0].size(), 8u);
  const auto tetsOf = [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t chunk = begin; chunk < end; ++chunk)
    {
      count += colours[0][chunk].size();
    }
    return static_cast<double>(count);
  };
  EXPECT_GT(tetsOf(0, 8), 0.7 * static_cast<double>(mesh.tets.size()));
  EXPECT_NEAR(tetsOf(0, 4), tetsOf(4, 8), 0.1 * tetsOf(0, 4));
}

}  // namespace soft_tissue
