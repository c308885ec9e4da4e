#pragma once

#include "file_cursor.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue
{
// One reader per file format. Each starts at the file's beginning, scales by metres_per_unit and
// throws Error with the place and the reason. Sources: the formats' public manuals.

LoadedMesh readGmsh(FileCursor& cursor, double metres_per_unit);
LoadedMesh readLegacyVtk(FileCursor& cursor, double metres_per_unit);
LoadedMesh readVtu(FileCursor& cursor, double metres_per_unit);
LoadedMesh readTetgen(FileCursor& cursor, double metres_per_unit);
LoadedMesh readMedit(FileCursor& cursor, double metres_per_unit);
LoadedMesh readPly(FileCursor& cursor, double metres_per_unit);
LoadedMesh readObj(FileCursor& cursor, double metres_per_unit);
LoadedMesh readAsciiStl(FileCursor& cursor, double metres_per_unit);
LoadedMesh readBinaryStl(FileCursor& cursor, double metres_per_unit);

}  // namespace soft_tissue
