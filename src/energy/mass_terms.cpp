#include "soft_tissue_sim/energy/mass_terms.h"

#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
namespace
{
/** Adds a share of each element's mass to each of its vertices, and another to each edge. */
void addShares(const QuadraticTetMesh& rest, const std::vector<double>& densities, Index first_node,
               double of_vertex, double of_edge, std::vector<double>& masses)
{
  for (std::size_t e = 0; e < rest.elements.size(); ++e)
  {
    const QuadraticTet& n = rest.elements[e];
    const double volume =
        signedVolume6(rest.nodes[n[0]], rest.nodes[n[1]], rest.nodes[n[2]], rest.nodes[n[3]]) / 6.0;
    for (std::size_t k = 0; k < n.size(); ++k)
    {
      masses[first_node + n[k]] += (k < 4 ? of_vertex : of_edge) * volume * densities[e];
    }
  }
}
/** Sum of f(i) over all nodes of some ranges. */
template <typename Function>
double sumOver(const std::vector<NodeRange>& ranges, const Function& f)
{
  double all = 0.0;
  for (const NodeRange& range : ranges)
  {
    all += parallelSum(range.end - range.begin, kNodeGrain, [&](Index begin, Index end) {
      double sum = 0.0;
      for (Index i = range.begin + begin; i < range.begin + end; ++i)
      {
        sum += f(i);
      }
      return sum;
    });
  }
  return all;
}

/** Calls f(i) for all nodes of some ranges. */
template <typename Function>
void forNodes(const std::vector<NodeRange>& ranges, const Function& f)
{
  for (const NodeRange& range : ranges)
  {
    parallelForEach(range.begin, range.end, kNodeGrain, f);
  }
}
}  // namespace

void addLumpedMasses(const TetMesh& rest, const std::vector<double>& densities, Index first_node,
                     std::vector<double>& masses)
{
  for (std::size_t t = 0; t < rest.tets.size(); ++t)
  {
    const Tet& tet = rest.tets[t];
    const double volume = signedVolume6(rest.nodes[tet[0]], rest.nodes[tet[1]], rest.nodes[tet[2]],
                                        rest.nodes[tet[3]]) /
                          6.0;
    for (const Index node : tet)
    {
      masses[first_node + node] += 0.25 * volume * densities[t];
    }
  }
}

void addLumpedMasses(const TriMesh& rest, const std::vector<double>& surface_densities,
                     Index first_node, std::vector<double>& masses)
{
  for (std::size_t t = 0; t < rest.triangles.size(); ++t)
  {
    const Triangle& n = rest.triangles[t];
    const Vec3& a = rest.nodes[n[0]];
    const double area = 0.5 * (rest.nodes[n[1]] - a).cross(rest.nodes[n[2]] - a).norm();
    for (const Index node : n)
    {
      masses[first_node + node] += area * surface_densities[t] / 3.0;
    }
  }
}

void addLumpedMasses(const QuadraticTetMesh& rest, const std::vector<double>& densities,
                     Index first_node, std::vector<double>& masses)
{
  addShares(rest, densities, first_node, 1.0 / 36.0, 4.0 / 27.0, masses);
}

void addLoadMasses(const QuadraticTetMesh& rest, const std::vector<double>& densities,
                   Index first_node, std::vector<double>& masses)
{
  addShares(rest, densities, first_node, -1.0 / 20.0, 1.0 / 5.0, masses);
}

StepFormula StepFormula::bdf2(double step_s, double last_step_s)
{
  const double ratio = step_s / last_step_s;
  return {step_s * (1.0 + ratio) / (1.0 + 2.0 * ratio), ratio * ratio / (1.0 + 2.0 * ratio)};
}

double NodalSprings::value(const Points& x)
{
  return 0.5 * sumOver(nodes_,
                       [&](Index i) { return stiffness_[i] * (x[i] - places_[i]).squaredNorm(); });
}

void NodalSprings::addGradient(const Points& x, Points& gradient)
{
  forNodes(nodes_, [&](Index i) { gradient[i] += stiffness_[i] * (x[i] - places_[i]); });
}

double NodalSprings::valueAndGradient(const Points& x, Points& gradient)
{
  return 0.5 * sumOver(nodes_, [&](Index i) {
           const Vec3 off = x[i] - places_[i], force = stiffness_[i] * off;
           gradient[i] += force;
           return force.dot(off);
         });
}

void NodalSprings::addHessian(const Points& /*x*/, Curvature /*curvature*/, BlockMatrix& hessian)
{
  forNodes(nodes_, [&](Index i) {
    double* block = hessian.block(hessian.diagonal(i));
    block[0] += stiffness_[i];
    block[4] += stiffness_[i];
    block[8] += stiffness_[i];
  });
}

bool Inertia::beginStep(Index first, Index count, const StepStart& start,
                        const StepFormula& formula)
{
  const double per_square = 1.0 / (formula.effective_s * formula.effective_s);
  bool other = false;
  for (Index i = first; i < first + count; ++i)
  {
    places_[i] = start.position(i, formula) + formula.effective_s * start.velocity(i, formula);
    const double stiffness = per_square * masses_[i];
    other = other || stiffness != stiffness_[i];
    stiffness_[i] = stiffness;
  }
  return other;
}

void Drag::beginStep(Index first, Index count, const StepStart& start, const StepFormula& formula)
{
  for (Index i = first; i < first + count; ++i)
  {
    places_[i] = start.position(i, formula);
    stiffness_[i] = coefficients_[i] / formula.effective_s;
  }
}

double Gravity::value(const Points& x)
{
  return -sumOver(nodes_, [&](Index i) { return masses_[i] * acceleration_.dot(x[i]); });
}

void Gravity::addGradient(const Points& /*x*/, Points& gradient)
{
  forNodes(nodes_, [&](Index i) { gradient[i] -= masses_[i] * acceleration_; });
}

double Gravity::valueAndGradient(const Points& x, Points& gradient)
{
  return -sumOver(nodes_, [&](Index i) {
    const Vec3 force = masses_[i] * acceleration_;
    gradient[i] -= force;
    return force.dot(x[i]);
  });
}

double NodalLoads::value(const Points& x)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    sum -= forces_[i].dot(x[i]);
  }
  return sum;
}

void NodalLoads::addGradient(const Points& x, Points& gradient)
{
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    gradient[i] -= forces_[i];
  }
}

}  // namespace soft_tissue
