#pragma once

#include <Eigen/Dense>
#include <random>
#include <set>
#include <vector>

#include "soft_tissue_sim/energy/block_matrix.h"
#include "soft_tissue_sim/solver/linear_solver.h"
#include "support/mesh_samples.h"

namespace soft_tissue::test
{
/** Flat view of points, 3N. */
inline Eigen::Map<const Eigen::VectorXd> flat(const Points& points)
{
  return {points.data()->data(), 3 * static_cast<Eigen::Index>(points.size())};
}

inline Points randomPoints(Index count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Points points;
  for (Index i = 0; i < count; ++i)
  {
    const double x = uniform(random), y = uniform(random);
    points.emplace_back(x, y, uniform(random));
  }
  return points;
}

inline LinearReport solveWith(LinearSolver& solver, const BlockMatrix& a, const Points& b,
                              const Points& x, double tolerance, Points& d)
{
  solver.setMatrix(a, x);
  return solver.solve(b, tolerance, std::numeric_limits<int>::max(), d);
}

/** Adds B B^T with a random 12 x 12 B for each tet: symmetric positive semi-definite. */
inline void addRandomElements(const std::vector<Tet>& tets, unsigned seed, BlockMatrix& a)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const Tet& tet : tets)
  {
    Eigen::Matrix<double, 12, 12> b;
    for (double& value : b.reshaped())
    {
      value = uniform(random);
    }
    const Eigen::Matrix<double, 12, 12> element = b * b.transpose();
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        const Mat3 block = element.block<3, 3>(3 * i, 3 * j);
        if (tet[i] <= tet[j])
        {
          a.add(tet[i], tet[j], block);
        }
        else if (const Index below = a.find(tet[i], tet[j]); below >= 0)
        {
          Eigen::Map<Mat3>(a.block(below)) += block;  // for those who read both triangles
        }
      }
    }
  }
}

/** Adds `count` random vectors of `nodes_each` nodes each, with weights of about `weight`. */
inline void addRandomOuterProducts(int count, Index nodes_each, double weight, unsigned seed,
                                   BlockMatrix& a)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Adjacency nodes;
  nodes.offsets.push_back(0);
  for (int k = 0; k < count; ++k)
  {
    std::set<Index> some;
    while (static_cast<Index>(some.size()) < nodes_each)
    {
      some.insert(static_cast<Index>(random() % a.rows()));
    }
    nodes.items.insert(nodes.items.end(), some.begin(), some.end());
    nodes.offsets.push_back(static_cast<Index>(nodes.items.size()));
  }
  const Index first = a.outer().append(nodes);
  for (Index k = first; k < a.outer().size(); ++k)
  {
    a.outer().weights()[k] = weight * (1.5 + uniform(random));
    for (Index i = 3 * a.outer().offsets()[k]; i < 3 * a.outer().offsets()[k + 1]; ++i)
    {
      a.outer().vector(0)[i] = uniform(random);
    }
  }
}

/** Adds `value` to the diagonal of one node's block. */
inline void addDiagonal(BlockMatrix& a, Index node, double value)
{
  a.add(node, node, value * Mat3::Identity());
}

/** A random symmetric positive definite matrix on the pattern of random tets. */
inline BlockMatrix randomPositiveMatrix(Index rows, int tets, unsigned seed)
{
  const std::vector<Tet> elements = randomTets(rows, tets, seed);
  BlockMatrix a(nodeNeighbours(rows, elements));
  addRandomElements(elements, seed + 1, a);
  for (Index i = 0; i < rows; ++i)
  {
    addDiagonal(a, i, 0.5);
  }
  return a;
}

}  // namespace soft_tissue::test
