#include "soft_tissue_sim/energy/membrane_elasticity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "membrane_parts.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGrain = 512;  // patches or angles per parallel piece

inline __attribute__((always_inline)) AngleSides sidesOf(const AngleMoments& angle, const Points& x)
{
  const auto& n = angle.nodes;
  return {angle.rest, x[n[0]], x[n[1]], x[n[2]], x[n[3]]};
}

StretchState stretchOf(const PatchStiffness& patch, const Points& x)
{
  return {patch.stretch, x[patch.nodes[0]], x[patch.nodes[1]], x[patch.nodes[2]]};
}
}  // namespace

void MembraneParts::takeAngles(const Points& x)
{
  parallelFor(angleCount(), kGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      slopes[k].value = angleValue(angles[k].rest, sidesOf(angles[k], x));
    }
  });
}

void MembraneParts::takeSlopes(const Points& x)
{
  parallelFor(angleCount(), kGrain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      const AngleSides sides = sidesOf(angles[k], x);
      angleSlope(angles[k].rest, sides, slopes[k]);
      if (sides.leastArea() < 1.0)
      {
        fadeSlope(angles[k].rest, sides, slopes[k]);
      }
    }
  });
}

double MembraneParts::bendingOf(const PatchStiffness& patch, double* m) const
{
  double a[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < 3; ++k)
  {
    a[k] = patch.angles[k] >= 0 ? slopes[patch.angles[k]].value : 0.0;
  }
  const AngleStiffness& w = patch.w;
  m[0] = w[0] * a[0] + w[1] * a[1] + w[2] * a[2];
  m[1] = w[1] * a[0] + w[3] * a[1] + w[4] * a[2];
  m[2] = w[2] * a[0] + w[4] * a[1] + w[5] * a[2];
  return 0.5 * (a[0] * m[0] + a[1] * m[1] + a[2] * m[2]);
}

void MembraneParts::addForces(const Points& x, Index p, Points& gradient)
{
  const PatchStiffness& patch = patches[p];
  const auto& n = patch.nodes;
  const StretchState f = stretchOf(patch, x);
  Vec3 forces[3];
  stretchForces(patch.stretch, f, forces);
  for (int k = 0; k < 3; ++k)
  {
    gradient[n[k]] += forces[k];
  }
  double m[3];
  energies[p] = stretchEnergy(patch.stretch, f) + bendingOf(patch, m);
  for (int k = 0; k < 3; ++k)
  {
    for (int i = 0; patch.angles[k] >= 0 && i < 4; ++i)
    {
      gradient[n[patch.places[k][i]]] += m[k] * slopes[patch.angles[k]].by[i];
    }
  }
}

void MembraneParts::bend(const Points& x, const PatchStiffness& patch, bool positive,
                         Mat3 (*k)[6]) const
{
  // The angles' slopes on both sides of W.
  constexpr int kW[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Vec3 by[3][6], pull[3][6];
  for (int e = 0; e < 3; ++e)
  {
    std::fill_n(by[e], 6, Vec3::Zero());
    for (int i = 0; patch.angles[e] >= 0 && i < 4; ++i)
    {
      by[e][patch.places[e][i]] = slopes[patch.angles[e]].by[i];
    }
  }
  for (int e = 0; e < 3; ++e)
  {
    for (int i = 0; i < 6; ++i)
    {
      pull[e][i] = patch.w[kW[e][0]] * by[0][i] + patch.w[kW[e][1]] * by[1][i] +
                   patch.w[kW[e][2]] * by[2][i];
    }
  }
  for (int e = 0; e < 3; ++e)
  {
    for (int i = 0; i < 6; ++i)
    {
      // Of the nodes across the edges each moves one angle only.
      for (int j = i; (i < 3 || i == 3 + e) && j < 6; ++j)
      {
        k[i][j].noalias() += by[e][i] * pull[e][j].transpose();
      }
    }
  }
  for (int e = 0; e < 3; ++e)
  {
    if (positive || !patch.owned[e])
    {
      continue;
    }
    const AngleMoments& angle = angles[patch.angles[e]];
    const AngleSides sides = sidesOf(angle, x);
    if (sides.leastArea() < kNoArea)
    {
      continue;
    }
    const double moment = moments[angle.moments[0]] + moments[angle.moments[1]];
    Mat3 curvature[4][4];
    angleCurvature(sides, curvature);
    if (sides.leastArea() < 1.0)
    {
      AngleSlope slope;
      angleSlope(angle.rest, sides, slope);
      fadeCurvature(angle.rest, sides, slope, curvature);
    }
    for (int i = 0; i < 4; ++i)
    {
      for (int j = i; j < 4; ++j)
      {
        const int row = patch.places[e][i], column = patch.places[e][j];
        if (row <= column)
        {
          k[row][column] += moment * curvature[i][j];
        }
        else
        {
          k[column][row] += moment * curvature[i][j].transpose();
        }
      }
    }
  }
}

void MembraneParts::addStiffness(const Points& x, Index p, bool positive,
                                 BlockMatrix& hessian) const
{
  const PatchStiffness& patch = patches[p];
  const Index* position = positions.data() + kPatchBlocks * static_cast<std::size_t>(p);
  const BlockOrder* order = orders.data() + kPatchBlocks * static_cast<std::size_t>(p);
  for (int k = 0; k < kPatchBlocks; ++k)
  {
    // Blocks lie all over the matrix: they are on their way while the patch is computed.
    const double* block = hessian.block(std::max(position[k], 0));
    __builtin_prefetch(block, 1);
    __builtin_prefetch(block + 8, 1);
  }
  Mat3 k[6][6];
  for (int i = 0; i < 6; ++i)
  {
    std::fill(k[i] + i, k[i] + 6, Mat3::Zero());
  }
  Mat3 stretch[3];
  stretchStiffness(patch.stretch, stretchOf(patch, x), positive, stretch);
  k[1][1] = stretch[0];
  k[1][2] = stretch[1];
  k[2][2] = stretch[2];
  k[0][1] = -(stretch[0] + stretch[1].transpose());
  k[0][2] = -(stretch[1] + stretch[2]);
  k[0][0] = -(k[0][1] + k[0][2]);
  bend(x, patch, positive, k);
  for (int i = 0; i < 6; ++i)
  {
    for (int j = i; j < 6; ++j, ++position, ++order)
    {
      if (*position < 0)
      {
        continue;
      }
      Eigen::Map<Mat3> block(hessian.block(*position));
      if (*order != BlockOrder::transposed)
      {
        block += k[i][j];
      }
      if (*order != BlockOrder::as_it_is)
      {
        block += k[i][j].transpose();
      }
    }
  }
}

void MembraneParts::findPositions(const BlockMatrix& hessian)
{
  positions.clear();
  orders.clear();
  for (const PatchStiffness& patch : patches)
  {
    for (int i = 0; i < 6; ++i)
    {
      for (int j = i; j < 6; ++j)
      {
        const Index row = std::min(patch.nodes[i], patch.nodes[j]);
        const Index column = std::max(patch.nodes[i], patch.nodes[j]);
        const Index position = row < 0 ? -1 : hessian.find(row, column);
        if (row >= 0 && position < 0)
        {
          throw Error("the Hessian has no block for two nodes that a membrane couples");
        }
        const BlockOrder order =
            row == patch.nodes[i] ? BlockOrder::as_it_is : BlockOrder::transposed;
        positions.push_back(position);
        orders.push_back(i != j && row == column ? BlockOrder::both : order);
      }
    }
  }
  matrix_blocks = hessian.columns().size();
}

MembraneElasticity::MembraneElasticity(const TriMesh& rest,
                                       const std::vector<MembraneParameters>& parameters,
                                       Index first_node)
    : parts_(std::make_unique<MembraneParts>(rest, parameters, first_node))
{}

MembraneElasticity::~MembraneElasticity() = default;

double MembraneElasticity::value(const Points& x)
{
  parts_->takeAngles(x);
  return parallelSum(parts_->patchCount(), kGrain, [&](Index begin, Index end) {
    double sum = 0.0, m[3];
    for (Index p = begin; p < end; ++p)
    {
      const PatchStiffness& patch = parts_->patches[p];
      sum += stretchEnergy(patch.stretch, stretchOf(patch, x)) + parts_->bendingOf(patch, m);
    }
    return sum;
  });
}

void MembraneElasticity::addGradient(const Points& x, Points& gradient)
{
  parts_->takeSlopes(x);
  parts_->forPatches([&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p)
    {
      parts_->addForces(x, p, gradient);
    }
  });
}

double MembraneElasticity::valueAndGradient(const Points& x, Points& gradient)
{
  addGradient(x, gradient);
  return parallelSum(parts_->patchCount(), kGrain, [&](Index begin, Index end) {
    double sum = 0.0;
    for (Index p = begin; p < end; ++p)
    {
      sum += parts_->energies[p];
    }
    return sum;
  });
}

void MembraneElasticity::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  // A matrix whose pattern differs elsewhere has this body's blocks moved as one.
  if (parts_->matrix_blocks != hessian.columns().size() ||
      parts_->positions.front() != hessian.diagonal(parts_->patches.front().nodes[0]))
  {
    parts_->findPositions(hessian);
  }
  parts_->takeSlopes(x);
  parallelFor(parts_->patchCount(), kGrain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p)
    {
      parts_->bendingOf(parts_->patches[p], parts_->moments.data() + 3 * p);
    }
  });
  const bool positive = curvature == Curvature::positive;
  parts_->forPatches([&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p)
    {
      parts_->addStiffness(x, p, positive, hessian);
    }
  });
}

double MembraneElasticity::smallestAreaRatio(const Points& x) const
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const PatchStiffness& patch : parts_->patches)
  {
    smallest = std::min(smallest, stretchOf(patch, x).w);
  }
  return std::sqrt(smallest);
}

}  // namespace soft_tissue
