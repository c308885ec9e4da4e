#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "membrane_patches.h"
#include "membrane_stretch.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
constexpr int kPatchBlocks = 21;  ///< on and above the diagonal of a patch's six nodes

/** How a block of a patch goes into a matrix: where its two nodes stand in the other order it is
 * stored transposed, where they are one node the block and its transpose add up. */
enum class BlockOrder : std::uint8_t
{
  as_it_is,
  transposed,
  both,
};

/** A triangle with what is across its edges, ready to be added up. */
struct PatchStiffness
{
  std::array<Index, 6> nodes;
  std::array<Index, 3> angles;
  std::array<std::array<int, 4>, 3> places;
  std::array<bool, 3> owned;  ///< the first triangle of an angle answers for its curvature
  AngleStiffness w;
  StretchRest stretch;
};

/** An angle, and where its two sides keep its moments. */
struct AngleMoments
{
  std::array<Index, 4> nodes;
  std::array<Index, 2> moments;
  AngleRest rest;
};

/** What MembraneElasticity adds up. */
struct MembraneParts
{
  MembraneParts(const TriMesh& rest, const std::vector<MembraneParameters>& parameters,
                Index first_node);

  void takeAngles(const Points& x);
  void takeSlopes(const Points& x);
  /** m = W a. @return 1/2 a^T W a */
  double bendingOf(const PatchStiffness& patch, double* m) const;
  /** The patch's forces, and its energy into `energies`. */
  void addForces(const Points& x, Index p, Points& gradient);
  void findPositions(const BlockMatrix& hessian);
  /** Adds a patch's second derivative of bending, blocks (i, j) with i <= j of its nodes. */
  void bend(const Points& x, const PatchStiffness& patch, bool positive, Mat3 (*k)[6]) const;
  void addStiffness(const Points& x, Index p, bool positive, BlockMatrix& hessian) const;

  /** Calls body(begin, end) for ranges of patches, at once only for those that share no node. */
  template <typename Body>
  void forPatches(const Body& body) const
  {
    for (std::size_t colour = 0; colour + 1 < colours.size(); ++colour)
    {
      const Index first = colours[colour];
      parallelFor(colours[colour + 1] - first, 1, [&](Index begin, Index end) {
        body(chunks[first + begin], chunks[first + end]);
      });
    }
  }

  Index patchCount() const { return static_cast<Index>(patches.size()); }
  Index angleCount() const { return static_cast<Index>(angles.size()); }

  std::vector<PatchStiffness> patches;  ///< by colour of their chunks
  std::vector<AngleMoments> angles;
  std::vector<Index> chunks, colours;  ///< as in TetChunks

  std::vector<AngleSlope> slopes;  ///< per angle
  std::vector<double> moments;     ///< 3 per patch
  std::vector<double> energies;    ///< per patch
  std::vector<Index> positions;    ///< kPatchBlocks per patch, in the matrix last seen, or -1
  std::vector<BlockOrder> orders;  ///< of these
  std::size_t matrix_blocks = 0;
};

}  // namespace soft_tissue
