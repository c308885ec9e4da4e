#include "soft_tissue_sim/mesh/tetrahedralize.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "subprocess.h"
#include "text_numbers.h"

namespace soft_tissue
{
namespace
{
void needWatertight(const TriMesh& surface)
{
  const SurfaceCheck check = checkSurface(surface);
  if (!check.watertight())
  {
    throw Error("the surface bounds no volume; `mesh_tool repair` may help, its check says:\n" +
                toText(check));
  }
}

void writeText(const std::string& path, const std::string& text)
{
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out)
  {
    throw Error(path + ": can't be written");
  }
}

/** The surface as TetGen's .smesh: nodes, facets, no holes, no regions. */
std::string smeshText(const TriMesh& surface)
{
  std::string text = std::to_string(surface.nodes.size()) + " 3 0 0\n";
  for (std::size_t i = 0; i < surface.nodes.size(); ++i)
  {
    const Vec3& p = surface.nodes[i];
    text += std::to_string(i) + " " + decimal(p.x(), 17) + " " + decimal(p.y(), 17) + " " +
            decimal(p.z(), 17) + "\n";
  }
  text += std::to_string(surface.triangles.size()) + " 0\n";
  for (const Triangle& t : surface.triangles)
  {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
            "\n";
  }
  return text + "0\n0\n";
}

/** A Gmsh script that fills surface.stl. */
std::string gmshScript(double edge_length_m)
{
  std::string text = "Merge \"surface.stl\";\n";
  if (edge_length_m > 0.0)
  {
    text += "ClassifySurfaces{Pi, 1, 1, Pi};\nCreateGeometry;\n";
    text += "Mesh.CharacteristicLengthMax = " + decimal(edge_length_m, 17) + ";\n";
    text += "Mesh.CharacteristicLengthMin = " + decimal(edge_length_m, 17) + ";\n";
    text += "Mesh.CharacteristicLengthExtendFromBoundary = 0;\n";
  }
  text += "Surface Loop(1) = Surface{:};\nVolume(1) = {1};\nPhysical Volume(1) = {1};\n";
  return text + "Mesh.MshFileVersion = 2.2;\nMesh.Optimize = 1;\n";
}

void run(const std::vector<std::string>& words, const std::string& folder, double timeout_s,
         const std::string& result_file)
{
  const std::string& program = words[0];
  const ProgramResult result = runProgram(words, folder, timeout_s);
  if (!result.started)
  {
    throw Error(program + " is not installed; on Debian and Ubuntu: sudo apt install " + program);
  }
  const std::string its_words = result.output.empty() ? "" : "; it says:\n" + result.output;
  if (result.timed_out)
  {
    throw Error(program + " was ended after " + decimal(timeout_s) + " s" + its_words);
  }
  if (result.exit_code != 0 || !std::filesystem::exists(result_file))
  {
    const std::string how = result.exit_code < 0
                                ? "crashed"
                                : "ended with exit code " + std::to_string(result.exit_code);
    throw Error(program + " could not fill the surface (" + how + ")" + its_words);
  }
}
}  // namespace

TetMesh tetrahedralize(const TriMesh& surface, const TetrahedralizeOptions& options)
{
  if (options.program != "tetgen" && options.program != "gmsh")
  {
    throw Error("mesher " + inQuotes(options.program) + ", must be tetgen or gmsh");
  }
  if (!(options.edge_length_m >= 0.0) || !std::isfinite(options.edge_length_m))
  {
    throw Error("edge length = " + decimal(options.edge_length_m) + " m, must be finite and >= 0");
  }
  needWatertight(surface);
  const TemporaryFolder folder;
  const std::string base = folder.path() + "/surface";
  if (options.program == "gmsh")
  {
    saveStl(base + ".stl", surface);
    writeText(base + ".geo", gmshScript(options.edge_length_m));
    run({"gmsh", "-3", "surface.geo", "-o", "volume.msh"}, folder.path(), options.timeout_s,
        folder.path() + "/volume.msh");
    return loadTetMesh(folder.path() + "/volume.msh", 1.0).mesh;
  }
  writeText(base + ".smesh", smeshText(surface));
  std::string switches = "-pzq1.4";
  if (options.edge_length_m > 0.0)
  {
    const double regular_tet = std::pow(options.edge_length_m, 3) / (6.0 * std::sqrt(2.0));
    switches += "a" + decimal(regular_tet, 17);
  }
  run({"tetgen", switches, "surface.smesh"}, folder.path(), options.timeout_s, base + ".1.ele");
  return loadTetMesh(base + ".1.node", 1.0).mesh;
}

}  // namespace soft_tissue
