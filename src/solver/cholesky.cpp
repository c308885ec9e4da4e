#include "cholesky.h"

#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
/** Calls visit(j, i, block) for all blocks (j, i), j <= i, always in the same order. */
template <typename Visit>
void forEachBlock(const BlockMatrix& a, const Visit& visit)
{
  for (Index j = 0; j < a.rows(); ++j)
  {
    for (Index k = a.diagonal(j); k < a.offsets()[j + 1]; ++k)
    {
      visit(j, a.columns()[k], a.block(k));
    }
  }
  for (const Coupling& c : a.couplings())
  {
    visit(c.row, c.column, c.block.data());
  }
}

/** Calls visit(row, column) for the numbers of B and then of S, vector by vector. */
template <typename Visit>
void forEachOuter(const BlockMatrix& a, const Visit& visit)
{
  const OuterProducts& outer = a.outer();
  for (Index k = 0; k < outer.size(); ++k)
  {
    for (Index place = outer.offsets()[k]; place < outer.offsets()[k + 1]; ++place)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        visit(3 * a.rows() + k, 3 * outer.nodes()[place] + axis);
      }
    }
    visit(3 * a.rows() + k, 3 * a.rows() + k);
  }
}
}  // namespace

void Cholesky::setMatrix(const BlockMatrix& a, const Points& x)
{
  if (!hasPatternOf(a))
  {
    analyse(a);
  }
  fill(a);
  factor_.factorize(matrix_);
  iterative_->setMatrix(a, x);
}

LinearReport Cholesky::solve(const Points& b, double tolerance, int most_iterations, Points& d)
{
  if (factor_.info() != Eigen::Success)  // singular
  {
    return iterative_->solve(b, tolerance, most_iterations, d);
  }
  const auto negative = (factor_.vectorD().array() < 0.0).count();
  if (!factor_.vectorD().allFinite() || negative != expected_negative_)
  {
    d.assign(b.size(), Vec3::Zero());
    return {1, 1.0, true, false};
  }
  const auto size = static_cast<Eigen::Index>(3 * b.size());
  right_.setZero(matrix_.rows());
  right_.head(size) = Eigen::Map<const Eigen::VectorXd>(b.data()->data(), size);
  solution_ = factor_.solve(right_);
  d.resize(b.size());
  Eigen::Map<Eigen::VectorXd>(d.data()->data(), size) = solution_.head(size);
  return {1, 0.0, false, false};
}

double Cholesky::workOf(const BlockMatrix& a)
{
  if (!hasPatternOf(a))
  {
    analyse(a);
  }
  return factor_.work();
}

bool Cholesky::hasPatternOf(const BlockMatrix& a) const
{
  const auto samePlace = [](const Coupling& c, const Edge& place) {
    return c.row == place[0] && c.column == place[1];
  };
  return offsets_ == a.offsets() && columns_ == a.columns() &&
         outer_offsets_ == a.outer().offsets() && outer_nodes_ == a.outer().nodes() &&
         std::equal(a.couplings().begin(), a.couplings().end(), coupled_.begin(), coupled_.end(),
                    samePlace);
}

/** Pattern of the lower triangle: column 3j + k holds rows 3i + l >= 3j + k of blocks i >= j. */
void Cholesky::analyse(const BlockMatrix& a)
{
  offsets_ = a.offsets();
  columns_ = a.columns();
  coupled_.clear();
  for (const Coupling& c : a.couplings())
  {
    coupled_.push_back({c.row, c.column});
  }
  outer_offsets_ = a.outer().offsets();
  outer_nodes_ = a.outer().nodes();
  std::vector<Eigen::Triplet<double>> entries;
  forEachBlock(a, [&](Index j, Index i, const double*) {
    for (int column = 0; column < 3; ++column)
    {
      for (int row = i == j ? column : 0; row < 3; ++row)
      {
        entries.emplace_back(3 * i + row, 3 * j + column, 0.0);
      }
    }
  });
  forEachOuter(a, [&](int row, int column) { entries.emplace_back(row, column, 0.0); });
  const Index size = 3 * a.rows() + a.outer().size();
  matrix_.resize(size, size);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  factor_.analyzePattern(matrix_);
  places_.clear();
  forEachBlock(a, [&](Index j, Index i, const double*) {
    for (int column = 0; column < 3; ++column)
    {
      places_.push_back(placeOf(3 * i + (i == j ? column : 0), 3 * j + column));
    }
  });
  forEachOuter(a, [&](int row, int column) { places_.push_back(placeOf(row, column)); });
}

/** Where a number of the lower triangle stands in matrix_. */
Index Cholesky::placeOf(int row, int column) const
{
  const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
  const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
  return static_cast<Index>(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr());
}

void Cholesky::fill(const BlockMatrix& a)
{
  const Index* place = places_.data();
  forEachBlock(a, [&](Index j, Index i, const double* block) {
    for (int column = 0; column < 3; ++column)
    {
      // Block (i, j) below the diagonal is the transpose of the stored block (j, i).
      double* value = matrix_.valuePtr() + *place++;
      for (int row = i == j ? column : 0; row < 3; ++row)
      {
        *value++ = block[3 * row + column];
      }
    }
  });
  const OuterProducts& outer = a.outer();
  expected_negative_ = 0;
  for (Index k = 0; k < outer.size(); ++k)
  {
    const double weight = outer.weights()[k], root = std::sqrt(std::abs(weight));
    for (Index i = 3 * outer.offsets()[k]; i < 3 * outer.offsets()[k + 1]; ++i)
    {
      matrix_.valuePtr()[*place++] = root * outer.vector(0)[i];
    }
    matrix_.valuePtr()[*place++] = weight < 0.0 ? 1.0 : -1.0;
    expected_negative_ += weight < 0.0 ? 0 : 1;
  }
}

std::unique_ptr<LinearSolver> makeCholesky()
{
  return std::make_unique<Cholesky>();
}

}  // namespace soft_tissue
