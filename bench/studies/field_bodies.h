#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue::studies
{
/** A body whose field is studied, in three dimensions or in the plane z = 0. */
struct FieldBody
{
  std::string name;
  int dimension = 3;
  std::size_t elements = 0;
  Points x;
  Adjacency neighbours;
  BoundarySurface surface;

  FieldTopology topology() const { return {&surface, &neighbours}; }
};

FieldBody bodyOfTets(const std::string& name, const TetMesh& mesh);

/** The unit disc: rings of triangles, 486 nodes. */
FieldBody disc();
/** A rectangle of 1 x 0.625, columns x rows nodes at uneven distances, every other diagonal turned.
 */
FieldBody rectangle(int columns, int rows);
/** The same without a quarter, and with a slit up to its middle: not convex, and cut. */
FieldBody cutRectangle(int columns, int rows);

/** Closed surfaces of as many triangles as those of the first paper's tables, around sample points
 * that are no nodes of anything: a sphere of 972, a torus of 2048, an apple with two hollows of
 * 384. */
FieldBody sphereOfTriangles();
FieldBody torusOfTriangles();
FieldBody appleOfTriangles();

}  // namespace soft_tissue::studies
