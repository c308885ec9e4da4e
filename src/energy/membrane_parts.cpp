#include "membrane_parts.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "coloured_chunks.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
constexpr Index kChunks = 48;  // a body is cut into at most, for its sums at nodes
constexpr Index kFewestPatches = 32;

void check(bool good, std::size_t triangle, const char* what, double value, const char* allowed)
{
  if (!good)
  {
    throw Error("triangle " + std::to_string(triangle) + " has " + what + " " +
                std::to_string(value) + ", must be " + allowed);
  }
}

StretchRest stretchRest(const Vec3& x0, const Vec3& x1, const Vec3& x2, const MembraneParameters& p)
{
  const Vec3 edge1 = x1 - x0, edge2 = x2 - x0;
  const double length = edge1.norm(), area2 = edge1.cross(edge2).norm();
  const double along = edge2.dot(edge1) / length;
  // In axes along and across the first edge: [length, along; 0, area2 / length], inverted.
  StretchRest rest;
  rest.inverse[0][0] = 1.0 / length;
  rest.inverse[0][1] = -along / area2;
  rest.inverse[1][0] = 0.0;
  rest.inverse[1][1] = length / area2;
  const double volume = 0.5 * area2 * p.thickness;
  rest.mu = volume * p.young_modulus / (2.0 * (1.0 + p.poisson_ratio));
  rest.kappa = volume * p.young_modulus / (2.0 * (1.0 - p.poisson_ratio));
  return rest;
}

void checkTriangle(const TriMesh& rest, std::size_t t, const MembraneParameters& p)
{
  check(p.young_modulus > 0.0 && std::isfinite(p.young_modulus), t, "young_modulus",
        p.young_modulus, "> 0");
  check(p.poisson_ratio > -1.0 && p.poisson_ratio <= 0.5, t, "poisson_ratio", p.poisson_ratio,
        "in (-1, 0.5]");
  check(p.thickness > 0.0 && std::isfinite(p.thickness), t, "thickness", p.thickness, "> 0");
  const Triangle& n = rest.triangles[t];
  const Vec3 edge1 = rest.nodes[n[1]] - rest.nodes[n[0]];
  const Vec3 edge2 = rest.nodes[n[2]] - rest.nodes[n[0]];
  const double area = 0.5 * edge1.cross(edge2).norm();
  const double longest = std::max({edge1.norm(), edge2.norm(), (edge2 - edge1).norm()});
  check(area > 1e-12 * longest * longest && std::isfinite(area), t, "rest area", area,
        "> 0, m^2; mesh_tool repair removes such triangles");
}
}  // namespace

MembraneParts::MembraneParts(const TriMesh& rest, const std::vector<MembraneParameters>& parameters,
                             Index first_node)
{
  const auto count = static_cast<Index>(rest.nodes.size());
  for (std::size_t t = 0; t < rest.triangles.size(); ++t)
  {
    checkTriangle(rest, t, parameters[t]);
  }
  const MembranePatches mesh = findPatches(count, rest.triangles);
  const std::vector<AngleStiffness> stiffness = fitAngleStiffness(rest, mesh, parameters);

  Points centres;
  std::vector<std::array<Index, 6>> elements;
  for (const MembranePatch& patch : mesh.patches)
  {
    elements.push_back(patch.nodes);
    centres.push_back(rest.nodes[patch.nodes[0]] + rest.nodes[patch.nodes[1]] +
                      rest.nodes[patch.nodes[2]]);
  }
  const std::vector<Index> order = mortonOrder(centres);
  const auto size = static_cast<std::size_t>(
      std::max(static_cast<Index>(order.size()) / kChunks, kFewestPatches));
  const std::vector<int> chunk_colours = colourChunks(rest.nodes.size(), elements, order, size);
  std::vector<Index> place(order.size());  // of a triangle among the patches
  chunks.push_back(0);
  colours.push_back(0);
  const int colour_count =
      chunk_colours.empty() ? 0 : 1 + *std::max_element(chunk_colours.begin(), chunk_colours.end());
  for (int colour = 0; colour < colour_count; ++colour)
  {
    for (std::size_t chunk = 0; chunk < chunk_colours.size(); ++chunk)
    {
      if (chunk_colours[chunk] != colour)
      {
        continue;
      }
      for (std::size_t k = chunk * size; k < std::min((chunk + 1) * size, order.size()); ++k)
      {
        const Index t = order[k];
        const MembranePatch& from = mesh.patches[t];
        place[t] = patchCount();
        PatchStiffness patch = {from.nodes, from.angles, from.places, {}, stiffness[t], {}};
        patch.stretch = stretchRest(rest.nodes[from.nodes[0]], rest.nodes[from.nodes[1]],
                                    rest.nodes[from.nodes[2]], parameters[t]);
        for (int edge = 0; edge < 3; ++edge)
        {
          patch.owned[edge] = from.angles[edge] >= 0 && from.places[edge][2] < 3;
        }
        for (Index& node : patch.nodes)
        {
          node += node >= 0 ? first_node : 0;
        }
        patches.push_back(patch);
      }
      chunks.push_back(patchCount());
    }
    colours.push_back(static_cast<Index>(chunks.size()) - 1);
  }
  for (const MembraneAngle& from : mesh.angles)
  {
    AngleMoments angle;
    const auto& n = from.nodes;
    const AngleSides sides({0.0, {1.0, 1.0}}, rest.nodes[n[0]], rest.nodes[n[1]], rest.nodes[n[2]],
                           rest.nodes[n[3]]);
    angle.rest.angle = angleBetween(sides);
    for (int side = 0; side < 2; ++side)
    {
      angle.rest.inverse[side] = 1.0 / (kSmallArea * kSmallArea * sides[side].area2);
      angle.moments[side] = 3 * place[from.triangles[side]] + from.edges[side];
    }
    for (int k = 0; k < 4; ++k)
    {
      angle.nodes[k] = first_node + n[k];
    }
    angles.push_back(angle);
  }
  slopes.resize(angles.size());
  moments.resize(3 * patches.size());
  energies.resize(patches.size());
}

}  // namespace soft_tissue
