#include "soft_tissue_sim/field/distance_field.h"

#include "closest_feature_marching.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
std::unique_ptr<DistanceField> makeDistanceField(const std::string& method,
                                                 const FieldTopology& topology)
{
  if (method == "cffm")
  {
    return std::make_unique<ClosestFeatureMarching>(topology);
  }
  throw Error("field method = \"" + method + "\", must be one of: cffm");
}

}  // namespace soft_tissue
