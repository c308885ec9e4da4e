#pragma once

#include <array>
#include <cstddef>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
// Meshes made by this package's own method; the same arguments give the same mesh.

/** Tag of the tets in the lobe's nodule; all other generated tets have tag 1. */
constexpr int kNoduleTag = 2;

/**
 * A box with one corner at the origin, cells[0] x cells[1] x cells[2] cells of six tets each, whose
 * diagonals all run the same way.
 * @param size_m  edge lengths, metres
 * @throws Error unless all cells are in [1, 1000] and all sizes > 0
 */
TetMesh makeBox(const std::array<int, 3>& cells, const Vec3& size_m);

/**
 * Cells of nearly equal edges that give a box of about `tets` tets.
 * @throws Error unless all sizes are > 0 and tets is in [6, 20000000]
 */
std::array<int, 3> cellsForBox(const Vec3& size_m, std::size_t tets);

/** A ball around the origin of about `tets` tets. @throws Error on a radius <= 0 or tets < 500 */
TetMesh makeBall(double radius_m, std::size_t tets);

/**
 * A torus around the z axis of about `tets` tets.
 * @throws Error unless 0 < tube_radius_m < ring_radius_m and tets >= 500
 */
TetMesh makeTorus(double ring_radius_m, double tube_radius_m, std::size_t tets);

/**
 * A tube along the z axis from z = 0 of about `tets` tets.
 * @throws Error unless 0 < inner_radius_m < outer_radius_m, length_m > 0 and tets >= 500
 */
TetMesh makeTube(double inner_radius_m, double outer_radius_m, double length_m, std::size_t tets);

/**
 * An organ-like lobe of about 0.10 x 0.08 x 0.04 m without symmetry, its flat bottom on z = 0, with
 * a spherical nodule of 9 mm radius (tag kNoduleTag) whose top lies 4 mm under the lobe's.
 * @throws Error if tets < 500
 */
TetMesh makeLobe(std::size_t tets);

/** How the cells of a sheet are cut into triangles. */
enum class SheetPattern
{
  diagonal,     ///< by diagonals that all run the same way
  alternating,  ///< by diagonals that run both ways in turn
  crossed,      ///< by both diagonals into four
  irregular,    ///< by either diagonal at random, inner nodes moved by up to a fifth of a cell
};

/**
 * A flat rectangle in z = 0 with one corner at the origin, its triangles seen counter-clockwise
 * from above.
 * @param cells   along x and y
 * @param size_m  edge lengths, metres
 * @throws Error unless all cells are in [1, 1000] and all sizes > 0
 */
TriMesh makeSheet(const std::array<int, 2>& cells, const std::array<double, 2>& size_m,
                  SheetPattern pattern);

}  // namespace soft_tissue
