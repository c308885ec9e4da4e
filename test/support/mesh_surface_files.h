#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"
#include "support/mesh_file_content.h"

namespace soft_tissue::test
{
inline std::string stlText(const TriMesh& mesh)
{
  Content out;
  out.text("solid a name\n");
  for (const Triangle& triangle : mesh.triangles)
  {
    out.text("facet normal 0 0 1\n outer loop\n");
    for (const Index node : triangle)
    {
      out.text("  vertex ").point<double>(mesh.nodes[node]).text("\n");
    }
    out.text(" endloop\nendfacet\n");
  }
  return out.text("endsolid a name\n").str();
}

inline std::string stlBinary(const TriMesh& mesh)
{
  Content out(true);
  out.text("solid but binary" + std::string(64, ' '));
  out.value(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles)
  {
    out.point<float>(Vec3::Zero());
    for (const Index node : triangle)
    {
      out.point<float>(mesh.nodes[node]);
    }
    out.value(std::uint16_t{0});
  }
  return out.str();
}

inline std::string objText(const TriMesh& mesh)
{
  Content out;
  out.text("# sample\no body\nvn 0 0 1\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.text("v ").point<double>(node).text("\n");
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
  {
    out.text("f");
    for (const Index node : mesh.triangles[i])
    {
      const auto number =
          static_cast<long>(i % 2 == 0 ? node + 1 : node - static_cast<long>(mesh.nodes.size()));
      out.text(" " + std::to_string(number) + (i % 3 == 0 ? "//1" : ""));
    }
    out.text("\n");
  }
  return out.str();
}

inline std::string plyContent(const TriMesh& mesh, const std::string& encoding)
{
  Content out(encoding != "ascii", encoding == "binary_big_endian");
  out.text("ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(mesh.nodes.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\n" +
           "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_index\nend_header\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.point<double>(node).value(std::uint8_t{200});
  }
  for (const Triangle& triangle : mesh.triangles)
  {
    out.value(std::uint8_t{3});
    for (const Index node : triangle)
    {
      out.value(std::int32_t{node});
    }
  }
  return out.str();
}

inline std::string vtkPolyContent(const TriMesh& mesh, bool binary)
{
  Content out(binary, true);
  out.text("# vtk DataFile Version 4.2\nsample\n").text(binary ? "BINARY\n" : "ASCII\n");
  out.text("DATASET POLYDATA\nPOINTS " + std::to_string(mesh.nodes.size()) + " float\n");
  for (const Vec3& node : mesh.nodes)
  {
    out.point<float>(node);
  }
  out.text("\nPOLYGONS " + std::to_string(mesh.triangles.size()) + " " +
           std::to_string(4 * mesh.triangles.size()) + "\n");
  for (const Triangle& triangle : mesh.triangles)
  {
    out.value(std::int32_t{3});
    for (const Index node : triangle)
    {
      out.value(std::int32_t{node});
    }
  }
  return out.text("\n").str();
}

/** The mesh in every surface format that is read. */
inline std::vector<SampleFile> surfaceFiles(const TriMesh& mesh)
{
  return {{"stl ascii", "a.stl", stlText(mesh), "", ""},
          {"stl binary", "a.stl", stlBinary(mesh), "", ""},
          {"obj", "a.obj", objText(mesh), "", ""},
          {"ply ascii", "a.ply", plyContent(mesh, "ascii"), "", ""},
          {"ply binary", "a.ply", plyContent(mesh, "binary_little_endian"), "", ""},
          {"ply binary", "a.ply", plyContent(mesh, "binary_big_endian"), "", ""},
          {"vtk 4.2 ascii POLYDATA", "a.vtk", vtkPolyContent(mesh, false), "", ""},
          {"vtk 4.2 binary POLYDATA", "a.vtk", vtkPolyContent(mesh, true), "", ""}};
}

}  // namespace soft_tissue::test
