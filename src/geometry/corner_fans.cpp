#include "corner_fans.h"

#include <vector>

namespace soft_tissue
{
namespace
{
/** Number of the cell with these sides along axis a and the two after it. */
unsigned cellAt(int a, unsigned side_a, unsigned side_b, unsigned side_c)
{
  return side_a << a | side_b << (a + 1) % 3 | side_c << (a + 2) % 3;
}

int faceAt(int a, unsigned side_b, unsigned side_c)
{
  return 4 * a + static_cast<int>(side_b + 2 * side_c);
}

int rootOf(const std::array<int, 12>& parent, int face)
{
  while (parent[face] != face)
  {
    face = parent[face];
  }
  return face;
}

void unite(std::array<int, 12>& parent, int one, int other)
{
  const int a = rootOf(parent, one);
  const int b = rootOf(parent, other);
  parent[a < b ? b : a] = a < b ? a : b;
}

CornerFans fansOf(unsigned occupied)
{
  const auto isOccupied = [&](unsigned cell) { return (occupied >> cell & 1U) != 0; };
  std::array<bool, 12> exposed{};
  std::array<int, 12> parent{};
  for (int face = 0; face < 12; ++face)
  {
    const unsigned b = face & 1, c = face >> 1 & 1;
    exposed[face] = isOccupied(cellAt(face / 4, 0, b, c)) != isOccupied(cellAt(face / 4, 1, b, c));
    parent[face] = face;
  }
  for (int a = 0; a < 3; ++a)  // the two edges along each axis that leave the corner
  {
    const int u = (a + 1) % 3, w = (a + 2) % 3;
    for (unsigned side = 0; side < 2; ++side)
    {
      // A cell of these four lies between the faces across u on its side of w, and across w.
      const auto acrossU = [&](unsigned side_w) { return faceAt(u, side_w, side); };
      const auto acrossW = [&](unsigned side_u) { return faceAt(w, side, side_u); };
      const std::array<int, 4> around = {acrossU(0), acrossU(1), acrossW(0), acrossW(1)};
      std::vector<int> on_surface;
      for (const int face : around)
      {
        if (exposed[face])
        {
          on_surface.push_back(face);
        }
      }
      if (on_surface.size() == 2)
      {
        unite(parent, on_surface[0], on_surface[1]);
      }
      for (unsigned cell = 0; on_surface.size() == 4 && cell < 4; ++cell)
      {
        if (isOccupied(cellAt(a, side, cell & 1U, cell >> 1U)))
        {
          unite(parent, acrossU(cell >> 1U), acrossW(cell & 1U));
        }
      }
    }
  }
  CornerFans fans;
  fans.fan.fill(-1);
  for (int face = 0; face < 12; ++face)
  {
    if (exposed[face])
    {
      const int root = rootOf(parent, face);
      fans.fan[face] = root == face ? static_cast<std::int8_t>(fans.count++) : fans.fan[root];
    }
  }
  return fans;
}
}  // namespace

const CornerFans& cornerFans(unsigned occupied)
{
  static const std::vector<CornerFans> all = [] {
    std::vector<CornerFans> table;
    for (unsigned cells = 0; cells < 256; ++cells)
    {
      table.push_back(fansOf(cells));
    }
    return table;
  }();
  return all[occupied];
}

}  // namespace soft_tissue
