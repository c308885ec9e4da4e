#include "voxel_net.h"

#include <algorithm>
#include <tuple>

#include "corner_fans.h"

namespace soft_tissue
{
namespace
{
// More of either smooths stairs further, and thins poles and single cells; walls keep their
// thickness in any case.
constexpr int kRounds = 3;
constexpr double kMostMoved = 0.35;  ///< of a cell, along each axis
constexpr int kPad = kRounds + 2;    ///< cells around the box whose faces have a say

class NetBuilder
{
 public:
  NetBuilder(const VoxelSet& cells, const CellBox& box)
      : box_(box),
        around_{box.low - Cell::Constant(kPad), box.high + Cell::Constant(kPad)},
        size_(around_.high - around_.low),
        stride_{1, size_.x(), size_.x() * size_.y()}
  {
    cells.read(around_, occupied_);
    addCorners();
    addFaces();
    for (int round = 0; round < kRounds; ++round)
    {
      smooth();
    }
    faces_.erase(std::remove_if(faces_.begin(), faces_.end(),
                                [](const Face& face) { return face.ring > 1; }),
                 faces_.end());
  }

  VoxelNet net(double cell_size) const
  {
    SurfaceMesh all;
    for (const Vec3& node : nodes_)
    {
      all.nodes.push_back(cell_size * node);
    }
    for (const auto& [q, owner, ring] : faces_)
    {
      const bool other_way =
          (nodes_[q[3]] - nodes_[q[1]]).squaredNorm() < (nodes_[q[2]] - nodes_[q[0]]).squaredNorm();
      all.triangles.push_back(other_way ? Triangle{q[1], q[2], q[3]} : Triangle{q[0], q[1], q[2]});
      all.triangles.push_back(other_way ? Triangle{q[1], q[3], q[0]} : Triangle{q[0], q[2], q[3]});
    }
    return ownPart(all, pseudoNormals(all, twins(all)));
  }

 private:
  using Quad = std::array<Index, 4>;
  struct Face
  {
    Quad nodes;
    Index owner;  ///< number of its occupied cell
    int ring;     ///< how many cells that is away from the box; 0 or less: in it
  };

  /** Number of a cell, or of its lower corner. */
  Index numberOf(const Cell& at) const
  {
    return at.x() * stride_[0] + at.y() * stride_[1] + at.z() * stride_[2];
  }

  /** Calls visit(at, number) for each cell from `low` up to the last. */
  template <typename Visit>
  void forEachCell(int low, const Visit& visit) const
  {
    Cell at;
    for (at.z() = low; at.z() < size_.z(); ++at.z())
    {
      for (at.y() = low; at.y() < size_.y(); ++at.y())
      {
        at.x() = low;
        for (Index number = numberOf(at); at.x() < size_.x(); ++at.x(), ++number)
        {
          visit(at, number);
        }
      }
    }
  }

  /** A node for every sheet at every corner whose eight cells are known. */
  void addCorners()
  {
    first_node_.assign(occupied_.size(), -1);
    fans_.assign(occupied_.size(), nullptr);
    const Index dx = stride_[0], dy = stride_[1], dz = stride_[2];
    const std::array<Index, 8> down = {dx + dy + dz, dy + dz, dx + dz, dz, dx + dy, dy, dx, 0};
    forEachCell(1, [&](const Cell& at, Index number) {
      unsigned cells = 0;
      for (unsigned k = 0; k < 8; ++k)
      {
        cells |= static_cast<unsigned>(occupied_[number - down[k]]) << k;
      }
      if (cells == 0 || cells == 255)
      {
        return;
      }
      fans_[number] = &cornerFans(cells);
      first_node_[number] = static_cast<Index>(nodes_.size());
      for (int fan = 0; fan < fans_[number]->count; ++fan)
      {
        corners_.push_back((around_.low + at).cast<double>());
        nodes_.push_back(corners_.back());
      }
    });
  }

  /** Faces all of whose corners have nodes. */
  void addFaces()
  {
    forEachCell(0, [&](const Cell& at, Index number) {
      for (int a = 0; a < 3; ++a)
      {
        const Index next = number + stride_[a];
        if (at[a] + 1 == size_[a] || occupied_[number] == occupied_[next])
        {
          continue;
        }
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        if (at[b] == 0 || at[c] == 0 || at[b] + 1 == size_[b] || at[c] + 1 == size_[c])
        {
          continue;
        }
        const bool up = occupied_[number] != 0;
        const Cell owner = around_.low + at + (up ? 0 : 1) * Cell::Unit(a);
        const int ring = (box_.low - owner).cwiseMax(owner - box_.high + Cell::Ones()).maxCoeff();
        faces_.push_back({faceAbove(number, a, up), up ? number : next, ring});
      }
    });
  }

  /** Nodes of the face between a cell and the next one along axis a, seen from the free one. */
  Quad faceAbove(Index cell, int a, bool up) const
  {
    constexpr std::array<std::array<int, 2>, 4> kAround = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    Quad quad;
    for (int k = 0; k < 4; ++k)
    {
      const int b = kAround[k][0], c = kAround[k][1];
      const Index corner = cell + stride_[a] + b * stride_[(a + 1) % 3] + c * stride_[(a + 2) % 3];
      const int face = 4 * a + (1 - b) + 2 * (1 - c);
      quad[up ? k : 3 - k] = first_node_[corner] + fans_[corner]->fan[face];
    }
    return quad;
  }

  void smooth()
  {
    Points sums(nodes_.size(), Vec3::Zero());
    std::vector<int> counts(nodes_.size(), 0);
    for (const auto& [q, owner, ring] : faces_)
    {
      const Vec3 middle = 0.25 * (nodes_[q[0]] + nodes_[q[1]] + nodes_[q[2]] + nodes_[q[3]]);
      for (const Index node : q)
      {
        sums[node] += middle;
        ++counts[node];
      }
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i)
    {
      const Vec3 moved = sums[i] / std::max(counts[i], 1) - corners_[i];
      nodes_[i] = corners_[i] + moved.cwiseMax(-kMostMoved).cwiseMin(kMostMoved);
    }
  }

  /** Half-edges on the other sides, as closedSurfaceTwins() has them; -1 at the rim. Where sheets
   * touch along an edge, those of one cell belong together. */
  std::vector<Index> twins(const SurfaceMesh& all) const
  {
    struct HalfEdge
    {
      std::array<Index, 2> nodes;
      Index owner, id;
    };
    std::vector<HalfEdge> sorted;
    for (Index h = 0; h < 3 * static_cast<Index>(all.triangles.size()); ++h)
    {
      const Triangle& t = all.triangles[h / 3];
      const auto [low, high] = std::minmax(t[h % 3], t[(h + 1) % 3]);
      sorted.push_back({{low, high}, faces_[h / 6].owner, h});
    }
    std::sort(sorted.begin(), sorted.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.nodes, a.owner, a.id) < std::tie(b.nodes, b.owner, b.id);
    });
    std::vector<Index> twins(sorted.size(), -1);
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i)
    {
      if (sorted[i].nodes == sorted[i + 1].nodes)
      {
        twins[sorted[i].id] = sorted[i + 1].id;
        twins[sorted[i + 1].id] = sorted[i].id;
        ++i;
      }
    }
    return twins;
  }

  /** The faces of the box's own cells with the nodes they use. */
  VoxelNet ownPart(const SurfaceMesh& all, const PseudoNormals& normals) const
  {
    VoxelNet net;
    std::vector<Index> place(all.nodes.size(), -1);
    for (std::size_t i = 0; i < all.triangles.size(); ++i)
    {
      if (faces_[i / 2].ring > 0)
      {
        continue;
      }
      Triangle t = all.triangles[i];
      for (int k = 0; k < 3; ++k)
      {
        Index& node = place[t[k]];
        if (node < 0)
        {
          node = static_cast<Index>(net.mesh.nodes.size());
          net.mesh.nodes.push_back(all.nodes[t[k]]);
          net.normals.nodes.push_back(normals.nodes[t[k]]);
        }
        t[k] = node;
        net.normals.edges.push_back(normals.edges[3 * i + k]);
      }
      net.mesh.triangles.push_back(t);
      net.normals.faces.push_back(normals.faces[i]);
    }
    return net;
  }

  CellBox box_, around_;
  Cell size_;
  std::array<Index, 3> stride_;
  std::vector<std::uint8_t> occupied_;
  std::vector<Index> first_node_;        ///< a corner's, -1: its cells are not all known
  std::vector<const CornerFans*> fans_;  ///< a corner's
  Points corners_;                       ///< where nodes were, in cells
  Points nodes_;
  std::vector<Face> faces_;
};
}  // namespace

int voxelNetReach()
{
  return kPad;
}

VoxelNet voxelNet(const VoxelSet& cells, const CellBox& box)
{
  return NetBuilder(cells, box).net(cells.cellSize());
}

}  // namespace soft_tissue
