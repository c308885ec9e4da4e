#pragma once

#include <functional>
#include <utility>

#include "soft_tissue_sim/energy/term.h"
#include "support/block_matrices.h"

namespace soft_tissue::test
{
/** 1/2 (x - c)^T A (x - c). */
class QuadraticTerm : public EnergyTerm
{
 public:
  QuadraticTerm(BlockMatrix matrix, Points centre)
      : matrix_(std::move(matrix)), centre_(std::move(centre))
  {}

  double value(const Points& x) override
  {
    const Points gradient = gradientAt(x);
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      sum += 0.5 * (x[i] - centre_[i]).dot(gradient[i]);
    }
    return sum;
  }

  void addGradient(const Points& x, Points& gradient) override
  {
    const Points own = gradientAt(x);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      gradient[i] += own[i];
    }
  }

  void addHessian(const Points&, Curvature, BlockMatrix& hessian) override
  {
    for (std::size_t k = 0; k < matrix_.values().size(); ++k)
    {
      hessian.values()[k] += matrix_.values()[k];
    }
  }

 private:
  Points gradientAt(const Points& x) const
  {
    Points gradient(x.size(), Vec3::Zero());
    for (Index i = 0; i < matrix_.rows(); ++i)
    {
      for (Index k = matrix_.offsets()[i]; k < matrix_.offsets()[i + 1]; ++k)
      {
        const Index j = matrix_.columns()[k];
        gradient[i] += Eigen::Map<const Mat3>(matrix_.block(k)) * (x[j] - centre_[j]);
      }
    }
    return gradient;
  }

  BlockMatrix matrix_;
  Points centre_;
};

/** Sum of f over all coordinates of all nodes. */
class SeparableTerm : public EnergyTerm
{
 public:
  using Function = std::function<double(double)>;

  SeparableTerm(Function f, Function slope, Function curvature)
      : f_(std::move(f)), slope_(std::move(slope)), curvature_(std::move(curvature))
  {}

  double value(const Points& x) override
  {
    double sum = 0.0;
    for (const double coordinate : flat(x))
    {
      sum += f_(coordinate);
    }
    return sum;
  }

  void addGradient(const Points& x, Points& gradient) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      gradient[i] += x[i].unaryExpr(slope_);
    }
  }

  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      Vec3 diagonal = x[i].unaryExpr(curvature_);
      if (curvature == Curvature::positive)
      {
        diagonal = diagonal.cwiseMax(0.0);
      }
      const auto node = static_cast<Index>(i);
      hessian.add(node, node, diagonal.asDiagonal().toDenseMatrix());
    }
  }

 private:
  Function f_, slope_, curvature_;
};

/** Nodes that know nothing of each other. */
inline Adjacency noNeighbours(Index count)
{
  Adjacency none;
  none.offsets.assign(count + 1, 0);
  return none;
}

}  // namespace soft_tissue::test
