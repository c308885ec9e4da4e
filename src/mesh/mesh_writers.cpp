#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "text_numbers.h"

namespace soft_tissue
{
namespace
{
void writeFile(const std::string& path, const std::string& content)
{
  std::ofstream out(path, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out)
  {
    throw Error(path + ": can't be written");
  }
}

template <typename T>
void appendLittleEndian(std::string& out, T value)
{
  std::uint32_t bits = 0;
  static_assert(sizeof(T) <= sizeof(bits));
  std::memcpy(&bits, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i)
  {
    out += static_cast<char>((bits >> (8 * i)) & 0xFF);
  }
}

void appendVector(std::string& out, const Vec3& vector)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    appendLittleEndian(out, static_cast<float>(vector[axis]));
  }
}
}  // namespace

void saveGmsh(const std::string& path, const TetMesh& mesh, int digits)
{
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n";
  out += std::to_string(mesh.nodes.size()) + "\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    const Vec3& p = mesh.nodes[i];
    out += std::to_string(i + 1) + " " + decimal(p.x(), digits) + " " + decimal(p.y(), digits) +
           " " + decimal(p.z(), digits) + "\n";
  }
  out += "$EndNodes\n$Elements\n" + std::to_string(mesh.tets.size()) + "\n";
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
  {
    const std::string tag = std::to_string(mesh.tags.empty() ? 0 : mesh.tags[i]);
    out += std::to_string(i + 1) + " 4 2 " + tag + " " + tag;
    for (const Index node : mesh.tets[i])
    {
      out += " " + std::to_string(node + 1);
    }
    out += "\n";
  }
  out += "$EndElements\n";
  writeFile(path, out);
}

void saveStl(const std::string& path, const TriMesh& mesh)
{
  std::string out = "binary STL in metres, written by soft_tissue_sim";
  out.resize(80, ' ');
  appendLittleEndian(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles)
  {
    const Vec3& a = mesh.nodes[triangle[0]];
    const Vec3& b = mesh.nodes[triangle[1]];
    const Vec3& c = mesh.nodes[triangle[2]];
    const Vec3 normal = (b - a).cross(c - a);
    appendVector(out, normal.norm() > 0.0 ? Vec3(normal / normal.norm()) : Vec3(Vec3::Zero()));
    appendVector(out, a);
    appendVector(out, b);
    appendVector(out, c);
    appendLittleEndian(out, std::uint16_t{0});
  }
  writeFile(path, out);
}

}  // namespace soft_tissue
