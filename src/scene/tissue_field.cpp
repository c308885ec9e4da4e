#include "soft_tissue_sim/scene/tissue_field.h"

namespace soft_tissue
{
std::unique_ptr<DistanceField> makeDistanceField(const FieldConfig& config,
                                                 const FieldTopology& topology)
{
  FieldOptions options;
  options.grid_points = config.grid_points.value_or(options.grid_points);
  return makeDistanceField(config.method, topology, options);
}

}  // namespace soft_tissue
