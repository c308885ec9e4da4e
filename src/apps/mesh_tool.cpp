#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "cad/cad_surface.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/mesh/repair.h"
#include "soft_tissue_sim/mesh/tetrahedralize.h"

namespace
{
using namespace soft_tissue;

/** A call that can't be understood: the program shows its help and ends with 2. */
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** The words after a command: names, and options with a value each. */
struct Arguments
{
  std::vector<std::string> names;
  std::map<std::string, std::string> options;

  std::string option(const std::string& key, const std::string& fallback) const
  {
    const auto found = options.find(key);
    return found == options.end() ? fallback : found->second;
  }

  std::vector<double> numbers(const std::string& key, const std::vector<double>& fallback) const
  {
    std::vector<double> values;
    for (std::string rest = option(key, ""); !rest.empty();)
    {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      std::size_t used = 0;
      try
      {
        values.push_back(std::stod(rest, &used));
      }
      catch (const std::exception&)
      {
        used = 0;
      }
      if (used != comma || used == 0)
      {
        throw UsageError(key + " needs numbers with commas between, found '" + option(key, "") +
                         "'");
      }
      rest = rest.substr(std::min(comma + 1, rest.size()));
    }
    if (!values.empty() && values.size() != fallback.size())
    {
      throw UsageError(key + " needs " + std::to_string(fallback.size()) + " numbers");
    }
    return values.empty() ? fallback : values;
  }

  double unit() const
  {
    if (options.count("--unit") == 0)
    {
      throw UsageError("--unit m|cm|mm|um is needed: mesh files do not say their unit of length");
    }
    return metresPerUnit(options.at("--unit"));
  }
};

void print(const std::string& text)
{
  std::fputs(text.c_str(), stdout);
}

LoadedMesh load(const std::string& path, double metres_per_unit)
{
  LoadedMesh loaded = loadMesh(path, metres_per_unit);
  print(path + " (" + loaded.report.format + ")\n");
  for (const std::string& warning : loaded.report.warnings)
  {
    print("! " + warning + "\n");
  }
  if (loaded.report.ignored_elements > 0)
  {
    print("  " + std::to_string(loaded.report.ignored_elements) + " other elements ignored\n");
  }
  return loaded;
}

/** Writes a volume as Gmsh 2.2, a surface as binary STL, both in metres. */
void save(const std::string& path, const LoadedMesh& loaded)
{
  if (loaded.volume.tets.empty())
  {
    saveStl(path, loaded.surface);
    print("wrote " + path + " (binary STL, metres)\n");
  }
  else
  {
    saveGmsh(path, loaded.volume);
    print("wrote " + path + " (Gmsh 2.2, metres)\n");
  }
}

void check(const Arguments& arguments)
{
  const LoadedMesh loaded = load(arguments.names[0], arguments.unit());
  print(loaded.volume.tets.empty() ? toText(checkSurface(loaded.surface))
                                   : toText(checkMesh(loaded.volume)));
}

void repair(const Arguments& arguments)
{
  LoadedMesh loaded = load(arguments.names[0], arguments.unit());
  const RepairReport report =
      loaded.volume.tets.empty() ? repairSurface(loaded.surface) : repairMesh(loaded.volume);
  for (const std::string& sentence : report.done)
  {
    print("done: " + sentence + "\n");
  }
  for (const std::string& sentence : report.left)
  {
    print("left: " + sentence + "\n");
  }
  print(report.done.empty() ? "nothing to mend\n" : "");
  save(arguments.names[1], loaded);
}

void convert(const Arguments& arguments)
{
  save(arguments.names[1], load(arguments.names[0], arguments.unit()));
}

TetMesh makeNamed(const Arguments& arguments)
{
  const std::string& shape = arguments.names[0];
  const auto tets = static_cast<std::size_t>(arguments.numbers("--tets", {5000.0})[0]);
  if (shape == "lobe")
  {
    return makeLobe(tets);
  }
  if (shape == "ball")
  {
    return makeBall(arguments.numbers("--size", {0.05})[0], tets);
  }
  if (shape == "torus")
  {
    const std::vector<double> radii = arguments.numbers("--size", {0.05, 0.02});
    return makeTorus(radii[0], radii[1], tets);
  }
  if (shape == "tube")
  {
    const std::vector<double> sizes = arguments.numbers("--size", {0.01, 0.015, 0.1});
    return makeTube(sizes[0], sizes[1], sizes[2], tets);
  }
  if (shape == "box")
  {
    const std::vector<double> size = arguments.numbers("--size", {0.1, 0.02, 0.02});
    return makeBox(cellsForBox({size[0], size[1], size[2]}, tets), {size[0], size[1], size[2]});
  }
  throw UsageError("shape '" + shape + "', must be lobe, box, ball, torus, tube or sheet");
}

/** Squares of about the size that gives so many triangles, each cut into four. */
TriMesh makeSheetOf(const Arguments& arguments)
{
  const std::vector<double> size = arguments.numbers("--size", {0.1, 0.1});
  const double triangles = arguments.numbers("--triangles", {2000.0})[0];
  const double edge = std::sqrt(4.0 * size[0] * size[1] / triangles);
  const auto cells = [&](double length) {
    return static_cast<int>(std::clamp(std::round(length / edge), 1.0, 1e3));
  };
  return makeSheet({cells(size[0]), cells(size[1])}, {size[0], size[1]}, SheetPattern::crossed);
}

void generate(const Arguments& arguments)
{
  if (arguments.names[0] == "sheet")
  {
    LoadedMesh sheet;
    sheet.surface = makeSheetOf(arguments);
    save(arguments.names[1], sheet);
    return;
  }
  LoadedMesh made;
  made.volume = makeNamed(arguments);
  print(toText(checkMesh(made.volume)));
  const int digits = static_cast<int>(arguments.numbers("--digits", {17.0})[0]);
  saveGmsh(arguments.names[1], made.volume, digits);
  print("wrote " + arguments.names[1] + " (Gmsh 2.2, metres)\n");
}

void fill(const Arguments& arguments)
{
  const LoadedMesh loaded = load(arguments.names[0], arguments.unit());
  if (!loaded.volume.tets.empty())
  {
    throw Error(arguments.names[0] + ": is a volume mesh already");
  }
  TetrahedralizeOptions options;
  options.program = arguments.option("--with", options.program);
  options.edge_length_m = arguments.numbers("--edge-length", {options.edge_length_m})[0];
  options.timeout_s = arguments.numbers("--timeout", {options.timeout_s})[0];
  LoadedMesh filled;
  filled.volume = tetrahedralize(loaded.surface, options);
  print(toText(checkMesh(filled.volume)));
  save(arguments.names[1], filled);
}

void tessellate(const Arguments& arguments)
{
  const std::string& path = arguments.names[0];
  if (arguments.options.count("--chord") == 0)
  {
    throw UsageError("--chord METRES is needed: how far triangles may be from the surface");
  }
  const double chord = arguments.numbers("--chord", {0.0})[0];
  LoadedMesh made;
  const CadSurface cad = loadCadSurface(path, chord);
  made.surface = cad.mesh;
  print(path + " (" + cad.format + ", " + std::to_string(cad.faces) + " faces)\n");
  char line[200];
  std::snprintf(
      line, sizeof(line),
      "  triangles within %.3g m of the surface, looked for at %zu points; asked: %.3g m\n",
      cad.deviation_m, cad.samples, chord);
  print(line);
  print(cad.sewn ? "done: joined faces of no solid at their edges, 0.1 chord apart at most\n" : "");
  print(cad.turned ? "done: turned the surface, which was inside out\n" : "");
  print(toText(checkSurface(made.surface)));
  save(arguments.names[1], made);
}

struct Command
{
  const char* name;
  std::size_t names;  ///< words it needs beside the options
  std::vector<std::string> options;
  void (*run)(const Arguments&);
  const char* help;
};

const std::vector<Command> kCommands = {
    {"check",
     1,
     {"--unit"},
     check,
     "mesh_tool check FILE --unit m|cm|mm|um\n"
     "  Tells what a volume or surface mesh holds; lines with ! tell of trouble.\n"},
    {"repair",
     2,
     {"--unit"},
     repair,
     "mesh_tool repair IN OUT --unit m|cm|mm|um\n"
     "  Mends what can be mended, tells each thing it did and what is left, writes metres.\n"},
    {"convert",
     2,
     {"--unit"},
     convert,
     "mesh_tool convert IN OUT --unit m|cm|mm|um\n"
     "  Writes a volume as Gmsh 2.2, a surface as binary STL, in metres.\n"},
    {"generate",
     2,
     {"--tets", "--triangles", "--size", "--digits"},
     generate,
     "mesh_tool generate lobe|box|ball|torus|tube OUT [--tets N] [--size ...] [--digits N]\n"
     "mesh_tool generate sheet OUT [--triangles N] [--size X,Y]\n"
     "  Makes a mesh of about N tets or triangles. Sizes in metres: box X,Y,Z; ball R; torus\n"
     "  RING,TUBE radius; tube INNER,OUTER,LENGTH. The lobe has one size, and a nodule with tag "
     "2.\n"},
    {"tetrahedralize",
     2,
     {"--unit", "--with", "--edge-length", "--timeout"},
     fill,
     "mesh_tool tetrahedralize SURFACE OUT --unit m|cm|mm|um [--with tetgen|gmsh]\n"
     "                         [--edge-length METRES] [--timeout SECONDS]\n"
     "  Fills a closed surface with tets by TetGen or Gmsh, which must be installed. With an edge\n"
     "  length Gmsh builds the surface anew, finer or coarser; TetGen only bounds the tets' "
     "size.\n"},
    {"tessellate",
     2,
     {"--chord"},
     tessellate,
     "mesh_tool tessellate CAD OUT --chord METRES\n"
     "  Puts triangles in place of the faces of a STEP or IGES file, NURBS among them, no farther\n"
     "  from them than the chord, and checks that. Such files tell their unit themselves.\n"},
};

std::string helpText()
{
  std::string text = "mesh_tool COMMAND ...; `mesh_tool COMMAND --help` tells more\n\n";
  for (const Command& command : kCommands)
  {
    text += command.help;
  }
  return text;
}

Arguments parse(const Command& command, const std::vector<std::string>& words)
{
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    if (words[i].substr(0, 2) != "--")
    {
      arguments.names.push_back(words[i]);
      continue;
    }
    if (std::find(command.options.begin(), command.options.end(), words[i]) ==
        command.options.end())
    {
      throw UsageError("unknown option " + words[i]);
    }
    if (i + 1 == words.size())
    {
      throw UsageError(words[i] + " needs a value");
    }
    arguments.options[words[i]] = words[i + 1];
    ++i;
  }
  if (arguments.names.size() != command.names)
  {
    throw UsageError(std::string(command.name) + " needs " + std::to_string(command.names) +
                     " names, found " + std::to_string(arguments.names.size()));
  }
  return arguments;
}

int runCommand(const std::vector<std::string>& words)
{
  const bool wants_help = std::find(words.begin(), words.end(), "--help") != words.end();
  for (const Command& command : kCommands)
  {
    if (!words.empty() && words[0] == command.name)
    {
      if (wants_help)
      {
        print(command.help);
        return 0;
      }
      try
      {
        command.run(parse(command, {words.begin() + 1, words.end()}));
      }
      catch (const UsageError& error)
      {
        std::fprintf(stderr, "mesh_tool: %s\n%s", error.what(), command.help);
        return 2;
      }
      return 0;
    }
  }
  if (wants_help)
  {
    print(helpText());
    return 0;
  }
  std::fprintf(stderr, "%s", helpText().c_str());
  return 2;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    return runCommand({argv + 1, argv + argc});
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "mesh_tool: %s\n", error.what());
    return 1;
  }
}
