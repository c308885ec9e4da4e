#pragma once

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** Which second derivative a minimisation asks for. */
enum class Curvature
{
  exact,     ///< as it is: fast convergence, but possibly indefinite
  positive,  ///< its positive semi-definite part, element by element: always a way down
};

/**
 * One term of the potential, a function of the positions of all nodes of all bodies.
 *
 * x and gradient are N x 3, world frame, metres and newtons. Terms add to what is there. A virtual
 * call is per term and evaluation, never per element. What a term lags (frames, areas, nodal
 * depths) it takes before the minimisation starts; from there value, gradient and Hessian belong
 * together.
 */
class EnergyTerm
{
 public:
  virtual ~EnergyTerm() = default;

  /** Energy at x, joules. */
  virtual double value(const Points& x) = 0;

  /** gradient += d value / dx. */
  virtual void addGradient(const Points& x, Points& gradient) = 0;

  /** Both at once, for little more than one of them. @return the energy, J */
  virtual double valueAndGradient(const Points& x, Points& gradient)
  {
    addGradient(x, gradient);
    return value(x);
  }

  /** hessian += d2 value / dx2, or its positive semi-definite part; blocks with row <= column. */
  virtual void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) = 0;
};

}  // namespace soft_tissue
