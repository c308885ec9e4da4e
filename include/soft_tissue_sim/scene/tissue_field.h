#pragma once

#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** The field a scene asks for. It keeps the pointers of the topology. */
std::unique_ptr<DistanceField> makeDistanceField(const FieldConfig& config,
                                                 const FieldTopology& topology);

}  // namespace soft_tissue
