#pragma once

#include <cstddef>
#include <string>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** The element that a tissue of so many tets is computed with: its own, or what auto comes to. */
ElementKind elementOf(const TissueConfig& tissue, std::size_t tets);

/** What auto comes to, for the schema. */
std::string describeElementChoice();

}  // namespace soft_tissue
