#include <gtest/gtest.h>

#include <ostream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "support/mesh_files.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
struct Rejection
{
  std::string name;
  std::string file;
  std::string content;
  std::string place;   ///< what follows the path in the message
  std::string reason;  ///< found somewhere in it
};

const std::string kGmshHead = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kGmshNodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";
const std::string kVtkHead = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string kPoints = "POINTS 4 float\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

void PrintTo(const Rejection& rejection, std::ostream* out)
{
  *out << rejection.name;
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  return text.replace(text.find(from), from.size(), to);
}

std::vector<Rejection> rejections()
{
  const std::string vtu = test::vtuText(test::twoTets());
  const std::string medit = test::meditText(test::twoTets());
  const std::string ply = test::tetPlyText(test::twoTets());
  const std::string binary = test::gmsh2Content(test::twoTets(), true);
  const auto elements = [](const std::string& lines) {
    return kGmshHead + kGmshNodes + "$Elements\n" + lines + "$EndElements\n";
  };
  return {
      {"empty", "a.msh", "", ": ", "is empty"},
      {"garbage", "a.msh", "\x01\x02\xff\xfe garbage", ": ", "no known mesh format"},
      {"text", "a.txt", "once upon a time\n", ": ", "no known mesh format"},
      {"gmsh40", "a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n", ":2: ", "must be 1, 2.x or 4.1"},
      {"gmshDataSize", "a.msh", "$MeshFormat\n2.2 0 4\n", ":2: ", "data size = 4"},
      {"gmshNodeTwice", "a.msh", kGmshHead + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n",
       ":7: ", "node number 1 is used twice"},
      {"gmshHugeCount", "a.msh", kGmshHead + "$Nodes\n2000000000\n1 0 0 0\n",
       ":5: ", "declares 2000000000 nodes"},
      {"gmshNegativeCount", "a.msh", kGmshHead + "$Nodes\n-4\n", ":5: ", "number of nodes = -4"},
      {"gmshTooFewNodes", "a.msh", kGmshHead + "$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n",
       ":7: ", "expected '$EndNodes', found '2'"},
      {"gmshNan", "a.msh", kGmshHead + "$Nodes\n1\n1 0 nan 0\n$EndNodes\n", ":6: ", "y = nan"},
      {"gmshFar", "a.msh", kGmshHead + "$Nodes\n1\n1 0 0 2e6\n$EndNodes\n", ":6: ", "z = 2e+06"},
      {"gmshWord", "a.msh", kGmshHead + "$Nodes\n1\n1 0 zero 0\n$EndNodes\n",
       ":6: ", "must be a number, found 'zero'"},
      {"gmshUnknownNode", "a.msh", elements("1\n1 4 2 0 1 1 2 3 9\n"), ":13: ", "node 9"},
      {"gmshRepeatedNode", "a.msh", elements("1\n1 4 2 0 1 1 2 3 3\n"), ":13: ", "twice"},
      {"gmshHexahedron", "a.msh", elements("1\n1 5 0 1 2 3 4 1 2 3 4\n"),
       ":13: ", "mesh with tetrahedra only"},
      {"gmshUnknownType", "a.msh", elements("1\n1 99 0 1\n"), ":13: ", "type 99"},
      {"gmshNoElements", "a.msh", kGmshHead + kGmshNodes, ":11: ", "without elements"},
      {"gmshEmpty", "a.msh", elements("0\n"), ": ", "no tetrahedra and no triangles"},
      {"gmshElementsFirst", "a.msh", kGmshHead + "$Elements\n0\n$EndElements\n",
       ":4: ", "elements before the nodes"},
      {"gmshBinaryCut", "a.msh", binary.substr(0, 200), ": byte ", "declares 5 nodes"},
      {"vtkDataSet", "a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\n",
       ":4: ", "must be UNSTRUCTURED_GRID or POLYDATA"},
      {"vtkType", "a.vtk", kVtkHead + "POINTS 1 string\n", ":5: ", "'string' is not supported"},
      {"vtkCellSize", "a.vtk", kVtkHead + kPoints + "CELLS 1 5\n9 0 1 2 3\n",
       ":11: ", "has 9 nodes"},
      {"vtkTypeCount", "a.vtk", kVtkHead + kPoints + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 0\n",
       ":13: ", "0 cell types"},
      {"vtkNodesOfTet", "a.vtk", kVtkHead + kPoints + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n",
       ":11: ", "its type needs 4"},
      {"vtkNodeRange", "a.vtk", kVtkHead + kPoints + "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n",
       ":11: ", "node 4 does not exist, must be in [0, 3]"},
      {"vtkQuadratic", "a.vtk", kVtkHead + kPoints + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n24\n",
       ":11: ", "its type needs 10"},
      {"vtkWedge", "a.vtk", kVtkHead + kPoints + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n13\n",
       ":11: ", "VTK type 13"},
      {"vtkKeyword", "a.vtk", kVtkHead + "CELL 1 5\n", ":5: ", "unexpected keyword 'CELL'"},
      {"vtuAppended", "a.vtu", replaced(vtu, "format=\"ascii\"", "format=\"appended\""),
       ":7: ", "save the file as ASCII"},
      {"vtuCount", "a.vtu", replaced(vtu, "Points=\"5", "Points=\"4"), ":8: ", "more than the 4"},
      {"vtuEnd", "a.vtu", vtu.substr(0, vtu.find("</VTKFile>")), ":", "ends before '</VTKFile>'"},
      {"vtuKind", "a.vtu", "<VTKFile type=\"ImageData\">\n</VTKFile>", ":1: ", "'ImageData'"},
      {"tetgenAlone", "a.node", test::tetgenNodeText(test::twoTets(), 0), "", "no such file"},
      {"tetgenNumber", "a.node", "2 3 0 0\n0 0 0 0\n5 0 0 0\n", ":3: ", "a node number = 5"},
      {"tetgenDimension", "a.node", "2 2 0 0\n0 0 0\n", ":1: ", "must be 4"},
      {"meditKeyword", "a.mesh", replaced(medit, "Corners", "Curses"), ":12: ", "'Curses'"},
      {"meditDimension", "a.mesh", replaced(medit, "Dimension 3", "Dimension 2"), ":3: ", "= 2"},
      {"meditRange", "a.mesh", replaced(medit, "Tetrahedra\n2 \n1 ", "Tetrahedra\n2 \n7 "),
       ":16: ", "node 7 does not exist, must be in [1, 5]"},
      {"plyNoZ", "a.ply", replaced(ply, "double z", "double w"), ":4: ", "no property z"},
      {"plyTetOfThree", "a.ply", replaced(ply, "\n4 0 1 2 3", "\n3 0 1 2"),
       ":16: ", "has 3 nodes, must have 4"},
      {"plyHuge", "a.ply", replaced(ply, "vertex 5", "vertex 500000"), ":4: ", "declares 500000"},
      {"plyFormat", "a.ply", replaced(ply, "ascii", "ebcdic"), ":2: ", "PLY format must be"},
      {"stlEmpty", "a.stl", "solid a\nendsolid a\n", ": ", "is an empty mesh"},
      {"stlWord", "a.stl", "solid a\nface normal\n", ":2: ", "expected 'facet' or 'endsolid'"},
      {"stlCut", "a.stl", test::stlText(test::unitTetSurface()).substr(0, 100), ":",
       "the file ends"},
      {"stlBinaryCut", "a.stl",
       replaced(test::stlBinary(test::unitTetSurface()), "solid", "brick").substr(0, 200), ": ",
       "would have 284 bytes"},
      {"objIndex", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
       ":4: ", "node 4 does not exist"},
      {"objZero", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", ":4: ", "not 0"},
      {"objKeyword", "a.obj", "v 0 0 0\nwhat 1\n", ":2: ", "unexpected keyword 'what'"},
      {"objFaceOfTwo", "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", ":3: ", "must have 3 or more"},
  };
}

class MeshRejection : public testing::TestWithParam<Rejection>
{};

TEST_P(MeshRejection, namesFilePlaceAndReason)
{
  const test::ScratchFolder folder;
  const std::string path = folder.write(GetParam().file, GetParam().content);
  if (GetParam().name == "tetgenNumber")
  {
    folder.write("a.ele", test::tetgenEleText(test::twoTets(), 0));
  }
  try
  {
    loadMesh(path, 1.0);
    FAIL() << "was read";
  }
  catch (const Error& error)
  {
    const std::string message = error.what();
    const std::string stem = path.substr(0, path.rfind('.'));
    const std::string start = GetParam().place.empty() ? stem : path + GetParam().place;
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
    EXPECT_NE(message.find(GetParam().reason), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, MeshRejection, testing::ValuesIn(rejections()),
                         [](const auto& info) { return info.param.name; });

TEST(MeshRejection, missingFilesAndFoldersAreNamed)
{
  const test::ScratchFolder folder;
  EXPECT_THROW(loadMesh(folder.path("none.msh"), 1.0), Error);
  EXPECT_THROW(loadMesh(folder.path(""), 1.0), Error);
}

TEST(MeshRejection, unitMustBePositive)
{
  const test::ScratchFolder folder;
  const std::string path = folder.write("a.msh", test::gmsh2Content(test::twoTets(), false));
  for (const double unit : {0.0, -1.0, 1.0 / 0.0})
  {
    EXPECT_THROW(loadTetMesh(path, unit), Error);
  }
}

TEST(MeshRejection, surfaceIsNoVolumeAndVolumeNoSurface)
{
  const test::ScratchFolder folder;
  const std::string surface = folder.write("a.stl", test::stlText(test::unitTetSurface()));
  const std::string volume = folder.write("a.msh", test::gmsh2Content(test::twoTets(), false));
  EXPECT_THROW(loadTriMesh(volume, 1.0), Error);
  try
  {
    loadTetMesh(surface, 1.0);
    FAIL() << "was read";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("mesh_tool tetrahedralize"), std::string::npos);
  }
}
}  // namespace
}  // namespace soft_tissue
