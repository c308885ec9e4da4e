#pragma once

#include "formats.h"

namespace soft_tissue
{
using MeshReader = LoadedMesh (*)(FileCursor& cursor, double metres_per_unit);

/** The reader for a file, told by its content alone. @throws Error if no format fits */
MeshReader detectReader(const FileCursor& cursor);

}  // namespace soft_tissue
