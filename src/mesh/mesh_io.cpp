#include "soft_tissue_sim/mesh/mesh_io.h"

#include <cmath>
#include <utility>

#include "file_cursor.h"
#include "format_detection.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
LoadedMesh loadMesh(const std::string& path, double metres_per_unit)
{
  if (!(metres_per_unit > 0.0) || !std::isfinite(metres_per_unit))
  {
    throw Error(path + ": metres_per_unit = " + std::to_string(metres_per_unit) +
                ", must be finite and > 0");
  }
  FileCursor cursor(path);
  return detectReader(cursor)(cursor, metres_per_unit);
}

LoadedTetMesh loadTetMesh(const std::string& path, double metres_per_unit)
{
  LoadedMesh loaded = loadMesh(path, metres_per_unit);
  if (loaded.volume.tets.empty())
  {
    throw Error(path + ": holds a surface (" + std::to_string(loaded.surface.triangles.size()) +
                " triangles, no tetrahedra) where a volume mesh is needed; make one with "
                "`mesh_tool tetrahedralize`");
  }
  return {std::move(loaded.volume), std::move(loaded.report)};
}

LoadedTriMesh loadTriMesh(const std::string& path, double metres_per_unit)
{
  LoadedMesh loaded = loadMesh(path, metres_per_unit);
  if (!loaded.volume.tets.empty())
  {
    throw Error(path + ": holds a volume (" + std::to_string(loaded.volume.tets.size()) +
                " tetrahedra) where a surface mesh is needed");
  }
  return {std::move(loaded.surface), std::move(loaded.report)};
}

double metresPerUnit(const std::string& unit)
{
  if (unit == "m")
  {
    return 1.0;
  }
  if (unit == "cm")
  {
    return 1.0e-2;
  }
  if (unit == "mm")
  {
    return 1.0e-3;
  }
  if (unit == "um")
  {
    return 1.0e-6;
  }
  throw Error("length unit " + inQuotes(unit) + ", must be one of m, cm, mm, um");
}

}  // namespace soft_tissue
