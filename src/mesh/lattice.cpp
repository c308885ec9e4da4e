#include "work_mesh.h"

namespace soft_tissue
{
namespace
{
/** Numbers the nodes of the lattice: corners, then centres, then centres of bottom faces. */
class LatticeNumbers
{
 public:
  explicit LatticeNumbers(const std::array<int, 3>& cells)
      : cells_(cells),
        corners_((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1)),
        centres_(cells[0] * cells[1] * cells[2])
  {}

  Index corner(const std::array<int, 3>& c) const
  {
    return (c[2] * (cells_[1] + 1) + c[1]) * (cells_[0] + 1) + c[0];
  }
  Index centre(const std::array<int, 3>& c) const
  {
    return corners_ + (c[2] * cells_[1] + c[1]) * cells_[0] + c[0];
  }
  Index bottom(const std::array<int, 3>& c) const
  {
    return corners_ + centres_ + c[1] * cells_[0] + c[0];
  }

 private:
  std::array<int, 3> cells_;
  Index corners_;
  Index centres_;
};

/** The four tets between two nodes on either side of the cube face at `c` across `axis`. */
void addFaceTets(const LatticeNumbers& numbers, const std::array<int, 3>& c, int axis, Index below,
                 Index above, std::vector<Tet>& tets)
{
  std::array<int, 3> around[4] = {c, c, c, c};
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  ++around[1][u];
  ++around[2][u];
  ++around[2][v];
  ++around[3][v];
  for (int k = 0; k < 4; ++k)
  {
    tets.push_back({below, above, numbers.corner(around[k]), numbers.corner(around[(k + 1) % 4])});
  }
}
}  // namespace

WorkMesh makeLattice(const Vec3& low, const std::array<int, 3>& cells, double cube_m,
                     bool flat_bottom)
{
  WorkMesh work;
  const LatticeNumbers numbers(cells);
  const auto add = [&](int i, int j, int k, const Vec3& shift, bool on_bottom) {
    work.mesh.nodes.push_back(low + cube_m * (Vec3(i, j, k) + shift));
    work.constraints.push_back(on_bottom && flat_bottom ? kOnBottom : 0);
  };
  for (int layer = 0; layer < 3; ++layer)  // corners, centres, centres of bottom faces
  {
    const int more = layer == 0 ? 1 : 0;
    const Vec3 shift = layer == 0 ? Vec3(0, 0, 0) : Vec3(0.5, 0.5, layer == 1 ? 0.5 : 0.0);
    for (int k = 0; k < (layer == 2 ? 1 : cells[2] + more); ++k)
    {
      for (int j = 0; j < cells[1] + more; ++j)
      {
        for (int i = 0; i < cells[0] + more; ++i)
        {
          add(i, j, k, shift, k == 0 && layer != 1);
        }
      }
    }
  }
  for (int k = 0; k < cells[2]; ++k)
  {
    for (int j = 0; j < cells[1]; ++j)
    {
      for (int i = 0; i < cells[0]; ++i)
      {
        const std::array<int, 3> cell = {i, j, k};
        for (int axis = 0; axis < 3; ++axis)
        {
          std::array<int, 3> before = cell;
          --before[axis];
          if (cell[axis] > 0)
          {
            addFaceTets(numbers, cell, axis, numbers.centre(before), numbers.centre(cell),
                        work.mesh.tets);
          }
          else if (axis == 2 && flat_bottom)
          {
            addFaceTets(numbers, cell, axis, numbers.bottom(cell), numbers.centre(cell),
                        work.mesh.tets);
          }
        }
      }
    }
  }
  work.mesh.tags.assign(work.mesh.tets.size(), 1);
  return work;
}

}  // namespace soft_tissue
