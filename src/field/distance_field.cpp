#include "soft_tissue_sim/field/distance_field.h"

#include "exact_marching.h"
#include "feature_marching.h"
#include "grid_marching.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
std::unique_ptr<DistanceField> makeDistanceField(const std::string& method,
                                                 const FieldTopology& topology,
                                                 const FieldOptions& options)
{
  if (method == "cpfm")
  {
    return std::make_unique<FeatureMarching<NodeFeatures>>(topology);
  }
  if (method == "cffm")
  {
    return std::make_unique<FeatureMarching<TriangleFeatures>>(topology);
  }
  if (method == "exact_marching")
  {
    return std::make_unique<ExactMarching>(topology);
  }
  if (method == "grid")
  {
    return std::make_unique<GridMarching>(topology, options.grid_points);
  }
  throw Error("field method = \"" + method +
              "\", must be one of: cpfm, cffm, exact_marching, grid");
}

}  // namespace soft_tissue
