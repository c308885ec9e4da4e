/**
 * The constitutive laws, several tets at once. Included by kernel files only (see pack.h).
 */
#pragma once

#include "invariant_laws.h"
#include "other_laws.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** Calls use(law) with the law of a model. */
template <typename Use>
decltype(auto) withLaw(MaterialModel model, const Use& use)
{
  switch (model)
  {
    case MaterialModel::neo_hookean_log:
      return use(NeoHookeanLog());
    case MaterialModel::exponential:
      return use(Exponential());
    case MaterialModel::corotated:
      return use(Corotated());
    case MaterialModel::st_venant_kirchhoff:
      return use(StVenantKirchhoff());
    case MaterialModel::linear:
      return use(Linear());
    default:
      return use(NeoHookean());
  }
}

/** The law that has one more constant, a pressure, and is otherwise the same. */
template <typename Law>
struct Pressed
{
  using Type = WithPressure<Law>;
};
template <template <typename> class Law>
struct Pressed<Law<OfLame>>
{
  using Type = Law<OfLameAndPressure>;
};

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
