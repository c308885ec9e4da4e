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

/** Nodes in an order of elimination that fills little. */
std::vector<Index> nodesInOrder(const BlockMatrix& a)
{
  std::vector<Eigen::Triplet<double>> pairs;
  forEachBlock(a, [&](Index j, Index i, const double*) { pairs.emplace_back(i, j, 1.0); });
  Eigen::SparseMatrix<double> graph(a.rows(), a.rows());
  graph.setFromTriplets(pairs.begin(), pairs.end());
  const Eigen::SparseMatrix<double> both = graph.selfadjointView<Eigen::Lower>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(both, order);
  return {order.indices().begin(), order.indices().end()};
}

/** A node of outer product k that all others of it are neighbours of, or -1. */
Index middleOf(const BlockMatrix& a, Index k)
{
  const OuterProducts& outer = a.outer();
  const auto begin = outer.nodes().begin() + outer.offsets()[k];
  const auto end = outer.nodes().begin() + outer.offsets()[k + 1];
  const auto middle = std::find_if(begin, end, [&](Index node) {
    return std::all_of(begin, end, [&](Index other) { return a.find(node, other) >= 0; });
  });
  return middle == end ? -1 : *middle;
}

double signOf(double weight)
{
  return weight < 0.0 ? 1.0 : -1.0;  // of -S; what weighs nothing is a row of its own
}
}  // namespace

void Cholesky::setMatrix(const BlockMatrix& a, const Points& x)
{
  if (!hasPatternOf(a))
  {
    analyse(a);
  }
  const Index* place = places_.data();
  forEachNumber(a, [&](Index, Index, double number) { matrix_.valuePtr()[*place++] = number; });
  expected_negative_ = 0;
  for (const double weight : a.outer().weights())
  {
    expected_negative_ += signOf(weight) < 0.0 ? 1 : 0;
  }
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
  right_.setZero(matrix_.rows());
  for (std::size_t i = 0; i < b.size(); ++i)
  {
    right_.segment<3>(first_of_node_[i]) = b[i];
  }
  solution_ = factor_.solve(right_);
  d.resize(b.size());
  for (std::size_t i = 0; i < b.size(); ++i)
  {
    d[i] = solution_.segment<3>(first_of_node_[i]);
  }
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
  orderUnknowns(a);
  std::vector<Eigen::Triplet<double>> entries;
  forEachNumber(a,
                [&](Index row, Index column, double) { entries.emplace_back(row, column, 0.0); });
  const Index size = 3 * a.rows() + a.outer().size();
  matrix_.resize(size, size);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  factor_.analyzePattern(matrix_);
  places_.clear();
  forEachNumber(a,
                [&](Index row, Index column, double) { places_.push_back(placeOf(row, column)); });
}

void Cholesky::orderUnknowns(const BlockMatrix& a)
{
  std::vector<std::vector<Index>> outer_of(a.rows());
  std::vector<Index> last;
  for (Index k = 0; k < a.outer().size(); ++k)
  {
    const Index middle = middleOf(a, k);
    (middle < 0 ? last : outer_of[middle]).push_back(k);
  }
  first_of_node_.resize(a.rows());
  of_outer_.resize(a.outer().size());
  Index count = 0;
  for (const Index node : nodesInOrder(a))
  {
    first_of_node_[node] = count;
    count += 3;
    for (const Index k : outer_of[node])
    {
      of_outer_[k] = count++;
    }
  }
  for (const Index k : last)
  {
    of_outer_[k] = count++;
  }
}

/** Where a number of the lower triangle stands in matrix_. */
Index Cholesky::placeOf(int row, int column) const
{
  const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
  const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
  return static_cast<Index>(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr());
}

/** Calls visit(row, column, number) for all numbers of the lower triangle, always in the same
 * order. */
template <typename Visit>
void Cholesky::forEachNumber(const BlockMatrix& a, const Visit& visit) const
{
  const auto lower = [&](Index i, Index j, double number) {
    visit(std::max(i, j), std::min(i, j), number);
  };
  forEachBlock(a, [&](Index j, Index i, const double* block) {
    for (int column = 0; column < 3; ++column)
    {
      for (int row = 0; row < (i == j ? column + 1 : 3); ++row)
      {
        lower(first_of_node_[j] + row, first_of_node_[i] + column, block[3 * column + row]);
      }
    }
  });
  const OuterProducts& outer = a.outer();
  for (Index k = 0; k < outer.size(); ++k)
  {
    const double weight = outer.weights()[k], root = std::sqrt(std::abs(weight));
    for (Index place = outer.offsets()[k]; place < outer.offsets()[k + 1]; ++place)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        lower(of_outer_[k], first_of_node_[outer.nodes()[place]] + axis,
              root * outer.vector(place)[axis]);
      }
    }
    lower(of_outer_[k], of_outer_[k], signOf(weight));
  }
}

std::unique_ptr<LinearSolver> makeCholesky()
{
  return std::make_unique<Cholesky>();
}

}  // namespace soft_tissue
