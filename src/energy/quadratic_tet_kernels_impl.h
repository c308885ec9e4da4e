/**
 * Element loops over groups of quadratic tets, compiled once per instruction set by
 * quadratic_tet_kernels_*.cpp, which define what tet_kernels_*.cpp do.
 */
#pragma once

#include "quadratic_lanes.h"
#include "quadratic_stiffness_impl.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
template <typename Material>
void quadraticEnergy(const TetGroups& groups, Index begin, Index end, const double* x,
                     double* energies)
{
  forQuadraticLanes<Material>(
      groups, begin, end, x, [&](Index group, int lane, QuadraticLanes<Material>& t) {
        Pack sum = {};
        forGaussPoints<Material>(groups, group, lane, t, [&](int, const Lanes<Material>& at) {
          sum += Material::energy(at.f, at.constants);
        });
        store(energies + 8 * static_cast<long>(group) + lane, t.at.volume * sum);
      });
}

template <typename Material>
void quadraticGradient(const TetGroups& groups, Index begin, Index end, const double* x,
                       double* gradient, double* energies)
{
  forQuadraticLanes<Material>(
      groups, begin, end, x, [&](Index group, int lane, QuadraticLanes<Material>& t) {
        Pack sum = {};
        Pack by_edges[3][4][3];  // [axis][k][j]: derivative of the energy by d_kj
        Pack far[3][3] = {};
        forGaussPoints<Material>(groups, group, lane, t, [&](int k, const Lanes<Material>& at) {
          Pack density;
          const PackMat p = stressAndEnergy<Material>(at.f, at.constants, density);
          sum += density;
          for (int i = 0; i < 3; ++i)
          {
            for (int j = 0; j < 3; ++j)
            {
              const Pack* b = at.gradients.m[j];
              const Pack force =
                  at.volume * (p.m[i][0] * b[0] + p.m[i][1] * b[1] + p.m[i][2] * b[2]);
              far[i][j] += force;
              by_edges[i][k][j] = kNear * force;
            }
          }
        });
        store(energies + 8 * static_cast<long>(group) + lane, t.at.volume * sum);
        Pack g[padded(30)];
        for (int i = 0; i < 3; ++i)
        {
          Pack(*b)[3] = by_edges[i];
          Pack total = {};
          for (int j = 0; j < 3; ++j)
          {
            for (int k = 0; k < 4; ++k)
            {
              b[k][j] += kFar * far[i][j];
            }
          }
          for (int k = 1; k < 4; ++k)
          {
            // Vertex k, the edge from it to vertex 0, and those to vertices of higher number.
            const int j = k - 1;
            g[3 * k + i] = 4.0 * b[k][j] - ((b[0][j] + b[1][j]) + (b[2][j] + b[3][j]));
            g[3 * kBetween[0][k] + i] = 4.0 * (b[0][j] - (b[k][0] + b[k][1] + b[k][2]));
            total += g[3 * k + i] + g[3 * kBetween[0][k] + i];
            for (int l = k + 1; l < 4; ++l)
            {
              g[3 * kBetween[k][l] + i] = 4.0 * (b[k][l - 1] + b[l][j]);
              total += g[3 * kBetween[k][l] + i];
            }
          }
          g[i] = -total;
        }
        scatter<10>(groups, group, lane, g, gradient);
      });
}

template <typename Material>
void quadraticState(const TetGroups& groups, Index begin, Index end, const double* x, double* det_f,
                    double* von_mises)
{
  forQuadraticLanes<Material>(
      groups, begin, end, x, [&](Index group, int lane, QuadraticLanes<Material>& t) {
        Pack smallest = splat(1e300);
        const auto consider = [&](int, const Lanes<Material>& at) {
          const Pack j = determinant(at.f);
          smallest = j < smallest ? j : smallest;
        };
        forGaussPoints<Material>(groups, group, lane, t, consider);
        const auto deformAt = [&](const Pack* l) {
          Pack edges[3][3];
          for (int i = 0; i < 3; ++i)
          {
            for (int j = 0; j < 3; ++j)
            {
              edges[i][j] = (l[0] * t.edges[i][0][j] + l[1] * t.edges[i][1][j]) +
                            (l[2] * t.edges[i][2][j] + l[3] * t.edges[i][3][j]);
            }
          }
          deform(edges, t.at);
        };
        for (int k = 0; k < 4; ++k)
        {
          const Pack l[4] = {splat(k == 0), splat(k == 1), splat(k == 2), splat(k == 3)};
          deformAt(l);
          consider(k, t.at);
        }
        store(det_f + 8 * static_cast<long>(group) + lane, smallest);
        for (int part = 0; part < kTetParts && von_mises != nullptr; ++part)
        {
          const long at = kTetLanes * (kTetParts * static_cast<long>(group) + part) + lane;
          const double* place = groups.places + 4 * at - 3 * lane;
          const Pack l[4] = {load(place), load(place + 8), load(place + 16), load(place + 24)};
          deformAt(l);
          store(von_mises + at, vonMises<Material>(t.at.f, t.at.constants));
        }
      });
}

template <typename Material>
void quadraticRemember(const TetGroups& groups, Index begin, Index end, const double* x,
                       double* six)
{
  forQuadraticLanes<Material>(
      groups, begin, end, x, [&](Index group, int lane, QuadraticLanes<Material>& t) {
        forGaussPoints<Material>(groups, group, lane, t, [&](int k, const Lanes<Material>& at) {
          const long place = kGaussPoints * static_cast<long>(group) + k;
          remember<Material>(at.f, at.constants, six + 6 * kTetLanes * place + lane);
        });
      });
}

const TetKernels& quadraticMemoryKernels()
{
  static const TetKernels kernels = {10,
                                     kTetParts,
                                     kGaussPoints,
                                     kGaussPoints * StrainMemory::kConstants,
                                     kQuadraticTetBlocks,
                                     kQuadraticBlocks.data(),
                                     nullptr,
                                     quadraticEnergy<StrainMemory>,
                                     quadraticGradient<StrainMemory>,
                                     quadraticStiffness<StrainMemory, false>,
                                     quadraticStiffness<StrainMemory, true>,
                                     nullptr,
                                     quadraticRemember<StrainMemory>,
                                     nullptr,
                                     nullptr};
  return kernels;
}

template <typename Material>
const TetKernels& quadraticKernelsOf()
{
  static const TetKernels kernels = {10,
                                     kTetParts,
                                     kGaussPoints,
                                     Material::kConstants,
                                     kQuadraticTetBlocks,
                                     kQuadraticBlocks.data(),
                                     Material::constants,
                                     quadraticEnergy<Material>,
                                     quadraticGradient<Material>,
                                     quadraticStiffness<Material, false>,
                                     quadraticStiffness<Material, true>,
                                     quadraticState<Material>,
                                     quadraticRemember<Material>,
                                     &quadraticMemoryKernels(),
                                     nullptr};
  return kernels;
}

const TetKernels& quadraticKernelsFor(MaterialModel model)
{
  return withLaw(model,
                 [](auto law) -> const TetKernels& { return quadraticKernelsOf<decltype(law)>(); });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
