#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"
#include "support/mesh_file_content.h"
#include "support/mesh_surface_files.h"

namespace soft_tissue::test
{
inline std::string gmsh1Text(const TetMesh& mesh)
{
  Content out;
  out.text("$NOD\n").value(mesh.nodes.size()).text("\n");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    out.value(i + 1).point<double>(mesh.nodes[i]).text("\n");
  }
  out.text("$ENDNOD\n$ELM\n").value(mesh.tets.size()).text("\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.value(t + 1).value(4).value(mesh.tags[t]).value(9).value(4);
    for (const Index node : mesh.tets[t])
    {
      out.value(node + 1);
    }
    out.text("\n");
  }
  return out.text("$ENDELM\n").str();
}

inline std::string gmsh2Content(const TetMesh& mesh, bool binary, bool high_byte_first = false)
{
  Content out(binary, high_byte_first);
  out.text(binary ? "$MeshFormat\n2.2 1 8\n" : "$MeshFormat\n2.2 0 8\n");
  if (binary)
  {
    out.value(std::int32_t{1}).text("\n");
  }
  out.text("$EndMeshFormat\n$PhysicalNames\n1\n3 2 \"nodule\"\n$EndPhysicalNames\n$Nodes\n");
  out.text(std::to_string(mesh.nodes.size()) + "\n");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    out.value(static_cast<std::int32_t>(i + 1)).point<double>(mesh.nodes[i]);
  }
  out.text("\n$EndNodes\n$Elements\n" + std::to_string(mesh.tets.size()) + "\n");
  if (binary)
  {
    out.value(std::int32_t{4})
        .value(static_cast<std::int32_t>(mesh.tets.size()))
        .value(std::int32_t{2});
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.value(static_cast<std::int32_t>(t + 1));
    if (!binary)
    {
      out.value(std::int32_t{4}).value(std::int32_t{2});
    }
    out.value(std::int32_t{mesh.tags[t]}).value(std::int32_t{9});
    for (const Index node : mesh.tets[t])
    {
      out.value(std::int32_t{node + 1});
    }
  }
  return out.text("\n$EndElements\n").str();
}

/** Each tag becomes a volume entity 10 + tag with that physical tag. */
inline std::string gmsh4Content(const TetMesh& mesh, bool binary)
{
  using Size = std::int64_t;
  using Int = std::int32_t;
  Content out(binary);
  out.text(binary ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n4.1 0 8\n");
  if (binary)
  {
    out.value(Int{1}).text("\n");
  }
  std::vector<int> tags = mesh.tags;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  out.text("$EndMeshFormat\n$Entities\n");
  out.value(Size{1}).value(Size{0}).value(Size{0}).value(static_cast<Size>(tags.size()));
  out.value(Int{1}).point<double>(Vec3::Zero()).value(Size{0});
  for (const int tag : tags)
  {
    out.value(Int{10 + tag}).point<double>(Vec3::Zero()).point<double>(Vec3::Ones());
    out.value(Size{1}).value(Int{tag}).value(Size{1}).value(Int{-7});
  }
  const auto nodes = static_cast<Size>(mesh.nodes.size());
  out.text("\n$EndEntities\n$Nodes\n").value(Size{1}).value(nodes).value(Size{1}).value(nodes);
  out.value(Int{3}).value(Int{10}).value(Int{0}).value(nodes);
  for (Size i = 0; i < nodes; ++i)
  {
    out.value(Size{i + 1});
  }
  for (const Vec3& node : mesh.nodes)
  {
    out.point<double>(node);
  }
  const auto tets = static_cast<Size>(mesh.tets.size());
  out.text("\n$EndNodes\n$Elements\n").value(tets).value(tets).value(Size{1}).value(tets);
  for (Size t = 0; t < tets; ++t)
  {
    out.value(Int{3}).value(Int{10 + mesh.tags[t]}).value(Int{4}).value(Size{1}).value(Size{t + 1});
    for (const Index node : mesh.tets[t])
    {
      out.value(Size{node + 1});
    }
  }
  return out.text("\n$EndElements\n").str();
}

inline std::string vtkGridContent(const TetMesh& mesh, bool binary, bool version5 = false)
{
  Content out(binary, true);
  out.text(version5 ? "# vtk DataFile Version 5.1\n" : "# vtk DataFile Version 3.0\n");
  out.text("sample\n").text(binary ? "BINARY\n" : "ASCII\n").text("DATASET UNSTRUCTURED_GRID\n");
  out.text("POINTS " + std::to_string(mesh.nodes.size()) + " double\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.point<double>(node);
  }
  const std::size_t tets = mesh.tets.size();
  if (version5)
  {
    out.text("\nMETADATA\nINFORMATION 0\n\nCELLS " + std::to_string(tets + 1) + " " +
             std::to_string(4 * tets) + "\nOFFSETS vtktypeint64\n");
    for (std::size_t t = 0; t <= tets; ++t)
    {
      out.value(static_cast<std::int64_t>(4 * t));
    }
    out.text("\nCONNECTIVITY vtktypeint64\n");
  }
  else
  {
    out.text("\nCELLS " + std::to_string(tets) + " " + std::to_string(5 * tets) + "\n");
  }
  for (const Tet& tet : mesh.tets)
  {
    if (!version5)
    {
      out.value(std::int32_t{4});
    }
    for (const Index node : tet)
    {
      version5 ? out.value(std::int64_t{node}) : out.value(std::int32_t{node});
    }
  }
  out.text("\nCELL_TYPES " + std::to_string(tets) + "\n");
  for (std::size_t t = 0; t < tets; ++t)
  {
    out.value(std::int32_t{10});
  }
  return out.text("\nCELL_DATA 1\n").str();
}

inline std::string vtuText(const TetMesh& mesh)
{
  Content out;
  out.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n");
  out.text("<UnstructuredGrid><!-- a > b -->\n<Piece NumberOfPoints=\"");
  out.text(std::to_string(mesh.nodes.size()) + "\" NumberOfCells='");
  out.text(std::to_string(mesh.tets.size()) + "'>\n<PointData/>\n<Points>\n");
  out.text("<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.point<double>(node);
  }
  out.text("</DataArray>\n</Points>\n<Cells>\n<DataArray Name=\"connectivity\" format=\"ascii\">");
  for (const Tet& tet : mesh.tets)
  {
    for (const Index node : tet)
    {
      out.value(node);
    }
  }
  out.text("</DataArray>\n<DataArray Name=\"offsets\" format=\"ascii\">\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.value(4 * (t + 1));
  }
  out.text("</DataArray>\n<DataArray Name=\"types\" format=\"ascii\">\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.value(10);
  }
  return out.text("</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n").str();
}

inline std::string tetgenNodeText(const TetMesh& mesh, int base)
{
  Content out;
  out.text("# nodes\n").value(mesh.nodes.size()).text("3 1 1\n");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    out.value(i + base).point<double>(mesh.nodes[i]).text("0.5 1 # note\n");
  }
  return out.str();
}

inline std::string tetgenEleText(const TetMesh& mesh, int base)
{
  Content out;
  out.value(mesh.tets.size()).text("4 1\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.value(t + base);
    for (const Index node : mesh.tets[t])
    {
      out.value(node + base);
    }
    out.value(mesh.tags[t]).text("\n");
  }
  return out.str();
}

inline std::string meditText(const TetMesh& mesh)
{
  Content out;
  out.text("MeshVersionFormatted 2\n\nDimension 3\n# nodes\nVertices\n").value(mesh.nodes.size());
  for (const Vec3& node : mesh.nodes)
  {
    out.text("\n").point<double>(node).value(0);
  }
  out.text("\nCorners 1\n1\nTetrahedra\n").value(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    out.text("\n");
    for (const Index node : mesh.tets[t])
    {
      out.value(node + 1);
    }
    out.value(mesh.tags[t]);
  }
  return out.text("\nEnd\n").str();
}

inline std::string tetPlyText(const TetMesh& mesh)
{
  Content out;
  out.text(
      "ply\nformat ascii 1.0\ncomment sample\nelement vertex " + std::to_string(mesh.nodes.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement 3d_element " +
      std::to_string(mesh.tets.size()) + "\nproperty list uint uint vertex_indices\nend_header\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.point<double>(node).text("\n");
  }
  for (const Tet& tet : mesh.tets)
  {
    out.value(4);
    for (const Index node : tet)
    {
      out.value(node);
    }
    out.text("\n");
  }
  return out.str();
}

/** The mesh in every volume format that is read. */
inline std::vector<SampleFile> volumeFiles(const TetMesh& mesh)
{
  return {{"gmsh 1 ascii", "a.msh", gmsh1Text(mesh), "", ""},
          {"gmsh 2.2 ascii", "a.msh", gmsh2Content(mesh, false), "", ""},
          {"gmsh 2.2 binary", "a.msh", gmsh2Content(mesh, true), "", ""},
          {"gmsh 2.2 binary", "a.msh", gmsh2Content(mesh, true, true), "", ""},
          {"gmsh 4.1 ascii", "a.msh", gmsh4Content(mesh, false), "", ""},
          {"gmsh 4.1 binary", "a.msh", gmsh4Content(mesh, true), "", ""},
          {"vtk 3 ascii UNSTRUCTURED_GRID", "a.vtk", vtkGridContent(mesh, false), "", ""},
          {"vtk 3 binary UNSTRUCTURED_GRID", "a.vtk", vtkGridContent(mesh, true), "", ""},
          {"vtk 5.1 ascii UNSTRUCTURED_GRID", "a.vtk", vtkGridContent(mesh, false, true), "", ""},
          {"vtk 5.1 binary UNSTRUCTURED_GRID", "a.vtk", vtkGridContent(mesh, true, true), "", ""},
          {"vtu ascii", "a.vtu", vtuText(mesh), "", ""},
          {"tetgen ascii", "a.node", tetgenNodeText(mesh, 0), "a.ele", tetgenEleText(mesh, 0)},
          {"tetgen ascii", "a.ele", tetgenEleText(mesh, 1), "a.node", tetgenNodeText(mesh, 1)},
          {"medit ascii", "a.mesh", meditText(mesh), "", ""},
          {"ply ascii", "a.ply", tetPlyText(mesh), "", ""}};
}

}  // namespace soft_tissue::test
