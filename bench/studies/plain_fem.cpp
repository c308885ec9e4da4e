#include "plain_fem.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace soft_tissue::studies
{
namespace
{
/** The rotation nearest to F, by Newton's iteration; where F is inverted or nearly flat, by its
 * singular values. Source: [Higham1986] */
Mat3 rotationOf(const Mat3& f)
{
  if (f.determinant() > 1e-3)
  {
    Mat3 r = f;
    for (int k = 0; k < 30; ++k)
    {
      const Mat3 next = 0.5 * (r + r.inverse().transpose());
      const double change = (next - r).squaredNorm();
      r = next;
      if (change < 1e-24)
      {
        return r;
      }
    }
  }
  const Eigen::JacobiSVD<Mat3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0)
  {
    u.col(2) = -u.col(2);
  }
  return u * svd.matrixV().transpose();
}
}  // namespace

PlainFem::PlainFem(const TetMesh& rest, const std::vector<Index>& fixed,
                   const TetStiffnessParameters& law, double density_kg_per_m3,
                   const Options& options)
    : rest_(rest),
      options_(options),
      lame_(lameFrom(law.young_modulus, law.poisson_ratio)),
      unknown_(rest.nodes.size(), 0),
      masses_(rest.nodes.size(), 0.0),
      elements_(rest.tets.size()),
      x_(rest.nodes),
      v_(rest.nodes.size(), Vec3::Zero())
{
  for (const Index node : fixed)
  {
    unknown_[node] = -1;
  }
  Index unknowns = 0;
  for (Index& unknown : unknown_)
  {
    unknown = unknown < 0 ? -1 : unknowns++;
  }
  for (std::size_t e = 0; e < elements_.size(); ++e)
  {
    const Tet& tet = rest.tets[e];
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
    {
      edges.col(k) = rest.nodes[tet[k + 1]] - rest.nodes[tet[0]];
    }
    const Mat3 inverse = edges.inverse();
    elements_[e].volume = edges.determinant() / 6.0;
    elements_[e].gradients[0] = -inverse.colwise().sum().transpose();
    for (int k = 0; k < 4; ++k)
    {
      masses_[tet[k]] += 0.25 * density_kg_per_m3 * elements_[e].volume;
      if (k > 0)
      {
        elements_[e].gradients[k] = inverse.row(k - 1).transpose();
      }
    }
  }
  force_.resize(3 * unknowns);
  elastic_.resize(3 * unknowns);
  makePattern();
  solver_.setTolerance(options_.linear_tolerance);
}

void PlainFem::makePattern()
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto forBlocks = [this](const auto& body) {
    for (std::size_t e = 0; e < elements_.size(); ++e)
    {
      for (int a = 0; a < 4; ++a)
      {
        for (int b = 0; b < 4; ++b)
        {
          body(elements_[e].places[a][b], unknown_[rest_.tets[e][a]], unknown_[rest_.tets[e][b]]);
        }
      }
    }
  };
  forBlocks([&](std::array<Index, 3>&, Index row, Index column) {
    for (int k = 0; k < 9 && row >= 0 && column >= 0; ++k)
    {
      entries.emplace_back(3 * row + k / 3, 3 * column + k % 3, 0.0);
    }
  });
  matrix_.resize(force_.size(), force_.size());
  matrix_.setFromTriplets(entries.begin(), entries.end());
  forBlocks([&](std::array<Index, 3>& places, Index row, Index column) {
    for (int k = 0; k < 3; ++k)
    {
      places[k] =
          row < 0 || column < 0
              ? -1
              : static_cast<Index>(&matrix_.coeffRef(3 * row + k, 3 * column) - matrix_.valuePtr());
    }
  });
}

/** Adds forces to elastic_, and stiffness, rotations held, to matrix_. */
void PlainFem::addElement(std::size_t number)
{
  const Element& element = elements_[number];
  const Tet& tet = rest_.tets[number];
  Mat3 f = Mat3::Zero();
  for (int k = 0; k < 4; ++k)
  {
    f += x_[tet[k]] * element.gradients[k].transpose();
  }
  const Mat3 r = rotationOf(f);
  const double trace = (r.transpose() * f).trace() - 3.0;
  const Mat3 stress = 2.0 * lame_.mu * (f - r) + lame_.lambda * trace * r;
  std::array<Vec3, 4> turned;  // gradients in the world's axes
  for (int k = 0; k < 4; ++k)
  {
    turned[k] = r * element.gradients[k];
    if (unknown_[tet[k]] >= 0)
    {
      elastic_.segment<3>(3 * unknown_[tet[k]]) -= element.volume * stress * element.gradients[k];
    }
  }
  double* const values = matrix_.valuePtr();
  for (int a = 0; a < 4; ++a)
  {
    for (int b = 0; b < 4; ++b)
    {
      if (element.places[a][b][0] < 0)
      {
        continue;
      }
      Mat3 block = lame_.lambda * turned[a] * turned[b].transpose() +
                   lame_.mu * turned[b] * turned[a].transpose();
      block.diagonal().array() += lame_.mu * turned[a].dot(turned[b]);
      for (int row = 0; row < 3; ++row)
      {
        for (int column = 0; column < 3; ++column)
        {
          values[element.places[a][b][row] + column] += element.volume * block(row, column);
        }
      }
    }
  }
}

/** Forces and their derivative at x_. @return how far forces are from balance */
double PlainFem::assemble()
{
  Eigen::Map<Eigen::VectorXd>(matrix_.valuePtr(), matrix_.nonZeros()).setZero();
  elastic_.setZero();
  for (std::size_t e = 0; e < elements_.size(); ++e)
  {
    addElement(e);
  }
  const double inverse_square = 1.0 / (options_.step_s * options_.step_s);
  force_ = elastic_;
  double inertias = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i)
  {
    if (unknown_[i] < 0)
    {
      continue;
    }
    const Index row = 3 * unknown_[i];
    const Vec3 weight = masses_[i] * options_.gravity;
    const Vec3 inertia = masses_[i] * inverse_square * (target_[i] - x_[i]);
    force_.segment<3>(row) += weight + inertia;
    weights += weight.squaredNorm();
    inertias += inertia.squaredNorm();
    for (int k = 0; k < 3; ++k)
    {
      matrix_.coeffRef(row + k, row + k) += masses_[i] * inverse_square;
    }
  }
  return force_.norm() / (elastic_.norm() + std::sqrt(weights) + std::sqrt(inertias));
}

void PlainFem::step()
{
  target_ = x_;
  for (std::size_t i = 0; i < x_.size(); ++i)
  {
    target_[i] += options_.step_s * v_[i];
  }
  const Points before = x_;
  linear_iterations_ = 0;
  for (linearisations_ = 0; linearisations_ < options_.linearisations; ++linearisations_)
  {
    const double residual = assemble();
    if (linearisations_ > 0 && residual <= options_.tolerance)
    {
      break;
    }
    solver_.compute(matrix_);
    move_ = solver_.solve(force_);
    linear_iterations_ += static_cast<int>(solver_.iterations());
    for (std::size_t i = 0; i < x_.size(); ++i)
    {
      if (unknown_[i] >= 0)
      {
        x_[i] += move_.segment<3>(3 * unknown_[i]);
      }
    }
  }
  for (std::size_t i = 0; i < x_.size(); ++i)
  {
    v_[i] = (x_[i] - before[i]) / options_.step_s;
  }
}

}  // namespace soft_tissue::studies
