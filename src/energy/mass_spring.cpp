#include "soft_tissue_sim/energy/mass_spring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "coloured_chunks.h"
#include "soft_root.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGrain = 512;   // elements per parallel piece
constexpr Index kChunks = 48;   // a body is cut into at most, for its sums at nodes
constexpr Index kFewest = 128;  // elements in one of them
constexpr int kCellBlocks = 10;
constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/** A spring's length over that at rest. */
SoftRoot stretchOf(const Vec3& along, double inverse)
{
  return softRoot(inverse * along.squaredNorm());
}

/** Half the square of a spring's stretch. */
double springEnergy(const Vec3& along, double inverse)
{
  const double more = stretchOf(along, inverse).value - 1.0;
  return 0.5 * more * more;
}

/** Its derivative by the way from one end to the other, 1/m. */
Vec3 springPull(const Vec3& along, double inverse)
{
  const SoftRoot r = stretchOf(along, inverse);
  return 2.0 * inverse * (r.value - 1.0) * r.slope * along;
}

/** And its second one, 1/m^2. */
Mat3 springStiffness(const Vec3& along, double inverse, bool positive)
{
  const SoftRoot r = stretchOf(along, inverse);
  const double squared = along.squaredNorm();
  double across = 2.0 * inverse * (r.value - 1.0) * r.slope;
  double more =
      4.0 * inverse * inverse * (r.slope * r.slope + (r.value - 1.0) * r.curvature);  // lengthwise
  if (positive)
  {
    const double lengthwise = std::max(across + more * squared, 0.0);
    across = std::max(across, 0.0);
    more = squared > 0.0 ? (lengthwise - across) / squared : 0.0;
  }
  Mat3 k = more * along * along.transpose();
  k.diagonal().array() += across;
  return k;
}

/** Six times a tet's volume, and its derivatives by the nodes. */
double volume6(const Points& x, const std::array<Index, 4>& n)
{
  return signedVolume6(x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
}

void volumeSlopes(const Points& x, const std::array<Index, 4>& n, Vec3* slopes)
{
  const Vec3 a = x[n[1]] - x[n[0]], b = x[n[2]] - x[n[0]], c = x[n[3]] - x[n[0]];
  slopes[1] = b.cross(c);
  slopes[2] = c.cross(a);
  slopes[3] = a.cross(b);
  slopes[0] = -(slopes[1] + slopes[2] + slopes[3]);
}

Mat3 crossing(const Vec3& v)
{
  Mat3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

void check(bool good, std::size_t tet, const char* what, double value, const char* allowed)
{
  if (!good)
  {
    throw Error("tet " + std::to_string(tet) + " has " + what + " " + std::to_string(value) +
                ", must be " + allowed);
  }
}
}  // namespace

template <typename Body>
void MassSpring::Order::forChunks(const Body& body) const
{
  for (std::size_t colour = 0; colour + 1 < colours.size(); ++colour)
  {
    const Index first = colours[colour];
    parallelFor(colours[colour + 1] - first, 1,
                [&](Index begin, Index end) { body(chunks[first + begin], chunks[first + end]); });
  }
}

/** Near ones together, in chunks that are coloured so that those of one colour share no node. */
template <typename Element>
MassSpring::Order MassSpring::sortElements(const Points& rest, Index first_node,
                                           std::vector<Element>& elements)
{
  Points centres;
  std::vector<decltype(Element::nodes)> nodes;
  for (const Element& element : elements)
  {
    nodes.push_back(element.nodes);
    centres.push_back(Vec3::Zero());
    for (Index& node : nodes.back())
    {
      node -= first_node;
      centres.back() += rest[node] / static_cast<double>(nodes.back().size());
    }
  }
  const std::vector<Index> along = mortonOrder(centres);
  const auto size =
      static_cast<std::size_t>(std::max(static_cast<Index>(along.size()) / kChunks, kFewest));
  const std::vector<int> colours = colourChunks(rest.size(), nodes, along, size);
  const int count = colours.empty() ? 0 : 1 + *std::max_element(colours.begin(), colours.end());
  Order order;
  std::vector<Element> sorted;
  order.chunks.push_back(0);
  order.colours.push_back(0);
  for (int colour = 0; colour < count; ++colour)
  {
    for (std::size_t chunk = 0; chunk < colours.size(); ++chunk)
    {
      if (colours[chunk] == colour)
      {
        for (std::size_t k = chunk * size; k < std::min((chunk + 1) * size, along.size()); ++k)
        {
          sorted.push_back(elements[along[k]]);
        }
        order.chunks.push_back(static_cast<Index>(sorted.size()));
      }
    }
    order.colours.push_back(static_cast<Index>(order.chunks.size()) - 1);
  }
  elements = std::move(sorted);
  return order;
}

MassSpring::MassSpring(const TetMesh& rest, const std::vector<TetStiffnessParameters>& parameters,
                       Index first_node)
{
  std::map<std::array<Index, 2>, double> work;  // of springs by their nodes, J
  for (std::size_t t = 0; t < rest.tets.size(); ++t)
  {
    const TetStiffnessParameters& p = parameters[t];
    const double volume = volume6(rest.nodes, rest.tets[t]) / 6.0;
    check(volume > 0.0 && std::isfinite(volume), t, "rest volume", volume,
          "> 0, m^3; mesh_tool repair removes such tets");
    check(p.young_modulus > 0.0 && std::isfinite(p.young_modulus), t, "young_modulus",
          p.young_modulus, "> 0");
    check(p.poisson_ratio >= 0.25 && p.poisson_ratio < 0.5, t, "poisson_ratio", p.poisson_ratio,
          "in [0.25, 0.5)");
    const Lame lame = lameFrom(p.young_modulus, p.poisson_ratio);
    moduli_.push_back(2.5 * lame.mu);
    Cell cell = {rest.tets[t], 6.0 * volume, (lame.lambda - lame.mu) / (36.0 * volume)};
    inverse_lengths_.emplace_back();
    for (int k = 0; k < 6; ++k)
    {
      const Index i = cell.nodes[kEdges[k][0]], j = cell.nodes[kEdges[k][1]];
      inverse_lengths_.back()[k] = 1.0 / (rest.nodes[j] - rest.nodes[i]).squaredNorm();
      work[{first_node + std::min(i, j), first_node + std::max(i, j)}] += moduli_.back() * volume;
    }
    for (Index& node : cell.nodes)
    {
      node += first_node;
    }
    tets_.push_back(cell);
    if (p.poisson_ratio > 0.25)
    {
      cells_.push_back(cell);
    }
  }
  for (const auto& [nodes, joules] : work)
  {
    const Vec3 along = rest.nodes[nodes[1] - first_node] - rest.nodes[nodes[0] - first_node];
    springs_.push_back({nodes, 1.0 / along.squaredNorm(), joules});
  }
  spring_order_ = sortElements(rest.nodes, first_node, springs_);
  cell_order_ = sortElements(rest.nodes, first_node, cells_);
}

double MassSpring::value(const Points& x)
{
  const double of_springs =
      parallelSum(static_cast<Index>(springs_.size()), kGrain, [&](Index begin, Index end) {
        double sum = 0.0;
        for (Index k = begin; k < end; ++k)
        {
          const Spring& s = springs_[k];
          sum += s.work * springEnergy(x[s.nodes[1]] - x[s.nodes[0]], s.inverse);
        }
        return sum;
      });
  const double of_volumes =
      parallelSum(static_cast<Index>(cells_.size()), kGrain, [&](Index begin, Index end) {
        double sum = 0.0;
        for (Index k = begin; k < end; ++k)
        {
          const double change = volume6(x, cells_[k].nodes) - cells_[k].rest;
          sum += 0.5 * cells_[k].bulk * change * change;
        }
        return sum;
      });
  return of_springs + of_volumes;
}

void MassSpring::addGradient(const Points& x, Points& gradient)
{
  spring_order_.forChunks([&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      const Spring& s = springs_[k];
      const Vec3 pull = s.work * springPull(x[s.nodes[1]] - x[s.nodes[0]], s.inverse);
      gradient[s.nodes[0]] -= pull;
      gradient[s.nodes[1]] += pull;
    }
  });
  cell_order_.forChunks([&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      const Cell& cell = cells_[k];
      const double pressure = cell.bulk * (volume6(x, cell.nodes) - cell.rest);
      Vec3 slopes[4];
      volumeSlopes(x, cell.nodes, slopes);
      for (int i = 0; i < 4; ++i)
      {
        gradient[cell.nodes[i]] += pressure * slopes[i];
      }
    }
  });
}

double MassSpring::valueAndGradient(const Points& x, Points& gradient)
{
  addGradient(x, gradient);
  return value(x);
}

void MassSpring::findPositions(const BlockMatrix& hessian)
{
  positions_.clear();
  const auto find = [&](Index i, Index j) {
    positions_.push_back(hessian.find(std::min(i, j), std::max(i, j)));
  };
  for (const Spring& s : springs_)
  {
    find(s.nodes[0], s.nodes[0]);
    find(s.nodes[0], s.nodes[1]);
    find(s.nodes[1], s.nodes[1]);
  }
  for (const Cell& cell : cells_)
  {
    for (int i = 0; i < 4; ++i)
    {
      for (int j = i; j < 4; ++j)
      {
        find(cell.nodes[i], cell.nodes[j]);
      }
    }
  }
  if (*std::min_element(positions_.begin(), positions_.end()) < 0)
  {
    throw Error("the Hessian has no block for two nodes that a spring joins");
  }
  matrix_blocks_ = hessian.columns().size();
}

void MassSpring::addSpring(const Points& x, std::size_t spring, bool positive,
                           BlockMatrix& hessian) const
{
  const Spring& s = springs_[spring];
  const Mat3 k = s.work * springStiffness(x[s.nodes[1]] - x[s.nodes[0]], s.inverse, positive);
  const Index* position = positions_.data() + 3 * spring;
  Eigen::Map<Mat3>(hessian.block(position[0])) += k;
  Eigen::Map<Mat3>(hessian.block(position[1])) -= k;
  Eigen::Map<Mat3>(hessian.block(position[2])) += k;
}

void MassSpring::addVolume(const Points& x, std::size_t index, bool positive,
                           BlockMatrix& hessian) const
{
  const Cell& cell = cells_[index];
  Vec3 slopes[4];
  volumeSlopes(x, cell.nodes, slopes);
  Mat3 bends[4][4];  // second derivatives of the volume: those of nodes 1, 2, 3, then of node 0
  for (auto& row : bends)
  {
    std::fill_n(row, 4, Mat3::Zero());
  }
  for (int i = 1; i < 4 && !positive; ++i)
  {
    const int j = i % 3 + 1, k = j % 3 + 1;
    bends[i][j] = -crossing(x[cell.nodes[k]] - x[cell.nodes[0]]);
    bends[j][i] = bends[i][j].transpose();
  }
  for (int j = 1; j < 4; ++j)
  {
    bends[0][j] = -(bends[1][j] + bends[2][j] + bends[3][j]);
  }
  const double pressure = cell.bulk * (volume6(x, cell.nodes) - cell.rest);
  const Index* position = positions_.data() + 3 * springs_.size() + kCellBlocks * index;
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i; j < 4; ++j, ++position)
    {
      const Mat3 block = cell.bulk * slopes[i] * slopes[j].transpose() + pressure * bends[i][j];
      Eigen::Map<Mat3> sum(hessian.block(*position));
      if (cell.nodes[i] <= cell.nodes[j])
      {
        sum += block;
      }
      else
      {
        sum += block.transpose();
      }
    }
  }
}

void MassSpring::addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian)
{
  // A matrix whose pattern differs elsewhere has this body's blocks moved as one.
  if (matrix_blocks_ != hessian.columns().size() ||
      positions_[0] != hessian.diagonal(springs_[0].nodes[0]))
  {
    findPositions(hessian);
  }
  const bool positive = curvature == Curvature::positive;
  spring_order_.forChunks([&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      addSpring(x, k, positive, hessian);
    }
  });
  cell_order_.forChunks([&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k)
    {
      addVolume(x, k, positive, hessian);
    }
  });
}

double MassSpring::minDetF(const Points& x)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const Cell& tet : tets_)
  {
    smallest = std::min(smallest, volume6(x, tet.nodes) / tet.rest);
  }
  return smallest;
}

void MassSpring::vonMises(const Points& x, std::vector<float>& stress)
{
  stress.resize(tets_.size());
  parallelFor(static_cast<Index>(tets_.size()), kGrain, [&](Index begin, Index end) {
    for (Index t = begin; t < end; ++t)
    {
      const Cell& tet = tets_[t];
      Mat3 sum = Mat3::Zero();
      for (int k = 0; k < 6; ++k)
      {
        const Vec3 along = x[tet.nodes[kEdges[k][1]]] - x[tet.nodes[kEdges[k][0]]];
        sum += springPull(along, inverse_lengths_[t][k]) * along.transpose();
      }
      // A pressure, which is what volumes have, is none of it.
      sum.diagonal().array() -= sum.trace() / 3.0;
      const double share = moduli_[t] * tet.rest / std::abs(volume6(x, tet.nodes));
      stress[t] = static_cast<float>(std::sqrt(1.5) * share * sum.norm());
    }
  });
}

}  // namespace soft_tissue
