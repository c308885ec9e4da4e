#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::test
{
/** Lattice cells of a grid, six tets each around the cell's main diagonal: conforming. */
inline TetMesh latticeMesh(const std::array<int, 3>& cells,
                           const std::function<Vec3(const Vec3&)>& map,
                           const std::function<bool(int, int, int)>& keep = nullptr)
{
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const auto lattice = [&](const std::array<int, 3>& c) {
    return (c[2] * (cells[1] + 1) + c[1]) * (cells[0] + 1) + c[0];
  };
  std::vector<Index> number((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1), -1);
  TetMesh mesh;
  const auto nodeAt = [&](const std::array<int, 3>& c) {
    Index& node = number[lattice(c)];
    if (node < 0)
    {
      node = static_cast<Index>(mesh.nodes.size());
      mesh.nodes.push_back(
          map(Vec3(1.0 * c[0] / cells[0], 1.0 * c[1] / cells[1], 1.0 * c[2] / cells[2])));
    }
    return node;
  };
  for (int k = 0; k < cells[2]; ++k)
  {
    for (int j = 0; j < cells[1]; ++j)
    {
      for (int i = 0; i < cells[0]; ++i)
      {
        if (keep && !keep(i, j, k))
        {
          continue;
        }
        for (int order = 0; order < 6; ++order)
        {
          std::array<int, 3> corner = {i, j, k};
          Tet tet;
          tet[0] = nodeAt(corner);
          for (int step = 0; step < 3; ++step)
          {
            ++corner[kOrders[order][step]];
            tet[step + 1] = nodeAt(corner);
          }
          if (order >= 3)
          {
            std::swap(tet[2], tet[3]);
          }
          mesh.tets.push_back(tet);
          mesh.tags.push_back(0);
        }
      }
    }
  }
  return mesh;
}

/** Box from the origin to `size`. */
inline TetMesh boxMesh(const std::array<int, 3>& cells, const Vec3& size)
{
  return latticeMesh(cells, [&](const Vec3& p) { return Vec3(p.cwiseProduct(size)); });
}

/** Ball about the origin: cubic shells of the lattice become spheres. */
inline TetMesh ballMesh(int cells, double radius)
{
  return latticeMesh({cells, cells, cells}, [&](const Vec3& p) {
    const Vec3 q = 2.0 * p - Vec3::Ones();
    const double shell = q.cwiseAbs().maxCoeff();
    return shell == 0.0 ? Vec3(Vec3::Zero()) : Vec3(radius * shell * q.normalized());
  });
}

/** Balls of 5 and 3 cm in one mesh, 20 cm apart. */
inline TetMesh twoBalls()
{
  TetMesh two = ballMesh(6, 0.05);
  const Index first = static_cast<Index>(two.nodes.size());
  const TetMesh other = ballMesh(5, 0.03);
  for (const Vec3& p : other.nodes)
  {
    two.nodes.push_back(p + Vec3(0.2, 0, 0));
  }
  for (const Tet& t : other.tets)
  {
    two.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  }
  return two;
}

/** Three quarters of the unit square times a height of one half; n even. */
inline TetMesh lMesh(int n)
{
  return latticeMesh(
      {n, n, n / 2}, [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.5 * p.z()); },
      [n](int i, int j, int) { return i < n / 2 || j < n / 2; });
}

}  // namespace soft_tissue::test
