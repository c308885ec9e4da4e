#pragma once

#include <cstdint>

namespace soft_tissue
{
/** Index of a node, tetrahedron or triangle; -1 means "none". */
using Index = std::int32_t;

}  // namespace soft_tissue
