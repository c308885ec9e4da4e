#include "indented_block.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue::studies
{
namespace
{
/** From 0 to `length` in pieces about `finest` long at first, each longer by about `ratio`. */
std::vector<double> growingPieces(double finest, double ratio, double length)
{
  const int pieces = std::max(
      1,
      static_cast<int>(std::lround(std::log1p(length * (ratio - 1.0) / finest) / std::log(ratio))));
  std::vector<double> at;
  for (int k = 0; k <= pieces; ++k)
  {
    at.push_back(length * std::expm1(k * std::log(ratio)) / std::expm1(pieces * std::log(ratio)));
  }
  return at;
}

struct Disc
{
  Points nodes;
  std::vector<Triangle> triangles;

  void addCell(Index a, Index b, Index c, Index d)
  {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
};

/** A place of the square from -1 to 1 in the unit disc: squares about its middle turn into circles,
 * the rounder the farther out. */
Vec3 inDisc(double u, double v)
{
  const double square = std::max(std::abs(u), std::abs(v));
  if (square == 0.0)
  {
    return Vec3::Zero();
  }
  const Vec3 across(std::tan(M_PI_4 * u / square), std::tan(M_PI_4 * v / square), 0.0);
  const double round = square * square;
  return round * square * across.normalized() + (1.0 - round) * M_SQRT1_2 * Vec3(u, v, 0.0);
}

/** Cells within the first of the radii, rings of them from each to the next. */
Disc makeDisc(int around, const std::vector<double>& radii)
{
  Disc disc;
  const int side = around / 4;
  const auto at = [side](int i, int j) { return static_cast<Index>(i * (side + 1) + j); };
  for (int i = 0; i <= side; ++i)
  {
    for (int j = 0; j <= side; ++j)
    {
      disc.nodes.push_back(radii[0] * inDisc(2.0 * i / side - 1.0, 2.0 * j / side - 1.0));
      if (i > 0 && j > 0)
      {
        disc.addCell(at(i - 1, j - 1), at(i, j - 1), at(i, j), at(i - 1, j));
      }
    }
  }
  std::vector<Index> ring(around);
  for (int k = 0; k < side; ++k)
  {
    ring[k] = at(side, k);
    ring[side + k] = at(side - k, side);
    ring[2 * side + k] = at(0, side - k);
    ring[3 * side + k] = at(k, 0);
  }
  for (std::size_t r = 1; r < radii.size(); ++r)
  {
    const Index first = static_cast<Index>(disc.nodes.size());
    for (int k = 0; k < around; ++k)
    {
      disc.nodes.push_back(radii[r] * disc.nodes[ring[k]].normalized());
      const int next = (k + 1) % around;
      disc.addCell(ring[k], first + k, first + next, ring[next]);
    }
    std::iota(ring.begin(), ring.end(), first);
  }
  return disc;
}

/** Prisms from each depth to the next, of three tets each. */
TetMesh downwards(const Disc& disc, const std::vector<double>& depths)
{
  TetMesh mesh;
  for (const double depth : depths)
  {
    for (const Vec3& p : disc.nodes)
    {
      mesh.nodes.emplace_back(p - depth * Vec3::UnitZ());
    }
  }
  const Index layer = static_cast<Index>(disc.nodes.size());
  for (std::size_t k = 1; k < depths.size(); ++k)
  {
    for (Triangle t : disc.triangles)
    {
      std::sort(t.begin(), t.end());
      const Index up = static_cast<Index>(k - 1) * layer, down = up + layer;
      for (int corner = 0; corner < 3; ++corner)
      {
        // The corners up to this one above, those from it below: diagonals that neighbours share.
        Tet tet;
        for (int i = 0; i < 4; ++i)
        {
          tet[i] = i <= corner ? up + t[i] : down + t[i - 1];
        }
        if (signedVolume6(mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]],
                          mesh.nodes[tet[3]]) < 0.0)
        {
          std::swap(tet[2], tet[3]);
        }
        mesh.tets.push_back(tet);
      }
    }
  }
  return mesh;
}
}  // namespace

TetMesh blockAroundTip(int cells, double growth, double reach)
{
  TetMesh mesh = makeBox({2 * cells, 2 * cells, cells}, {2.0, 2.0, 1.0});
  for (Vec3& p : mesh.nodes)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      p[axis] = reach * std::sinh(growth * (p[axis] - 1.0)) / std::sinh(growth);
    }
  }
  return mesh;
}

TetMesh blockAroundEdge(int around, double edge_radius, double reach)
{
  const double finest = kEdgeCell / around * edge_radius, ratio = std::exp(8.5 / around);
  std::vector<double> radii;
  for (const double inwards : growingPieces(finest, ratio, 0.6 * edge_radius))
  {
    radii.insert(radii.begin(), edge_radius - inwards);
  }
  for (const double outwards : growingPieces(finest, ratio, reach - edge_radius))
  {
    if (outwards > 0.0)
    {
      radii.push_back(edge_radius + outwards);
    }
  }
  return downwards(makeDisc(around, radii), growingPieces(finest, ratio, reach));
}

}  // namespace soft_tissue::studies
