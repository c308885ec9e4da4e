#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** Tets below this quality are called slivers. */
constexpr double kSliverQuality = 0.1;

/**
 * Quality q = 6 sqrt(2) V / l_rms^3 of a tet: 1 when regular, 0 when flat, negative when left
 * handed. Source: [Parthasarathy1994], ratio of volume to root-mean-square edge length.
 */
double tetQuality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/** How the triangles of a surface hang together; triangles with a repeated node are left out. */
struct SurfaceTopology
{
  std::size_t open_edges = 0;             ///< edges of one triangle
  std::size_t flipped_edges = 0;          ///< edges two triangles run through in the same direction
  std::size_t non_manifold_edges = 0;     ///< edges of three or more triangles
  std::size_t non_manifold_vertices = 0;  ///< nodes where several fans of triangles touch
  std::size_t parts = 0;                  ///< hang together by shared nodes
};

/** What is to be known of a tet mesh before a simulation trusts it. */
struct MeshCheck
{
  std::size_t nodes = 0;
  std::size_t tets = 0;
  Vec3 size_m = Vec3::Zero();  ///< edges of the axis-aligned bounding box
  double volume_m3 = 0.0;      ///< signed sum
  std::size_t inverted = 0;    ///< left-handed tets
  std::size_t degenerate = 0;  ///< tets whose volume is zero to rounding
  std::size_t slivers = 0;     ///< tets with q < kSliverQuality, inverted and degenerate included
  double min_quality = 0.0;
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  std::size_t duplicate_nodes = 0;   ///< nodes at the place of an earlier one
  std::size_t orphan_nodes = 0;      ///< nodes in no tet
  std::size_t duplicate_tets = 0;    ///< tets with the nodes of an earlier one
  std::size_t overshared_faces = 0;  ///< faces of three or more tets
  std::size_t parts = 0;             ///< connected across faces
  std::size_t boundary_triangles = 0;
  SurfaceTopology boundary;
  std::map<int, std::size_t> tags;  ///< tets of each region tag
};

/** Checks a tet mesh; changes nothing. */
MeshCheck checkMesh(const TetMesh& mesh);

/** What is to be known of a surface. */
struct SurfaceCheck
{
  std::size_t nodes = 0;
  std::size_t triangles = 0;
  Vec3 size_m = Vec3::Zero();  ///< edges of the axis-aligned bounding box
  double area_m2 = 0.0;
  double volume_m3 = 0.0;     ///< signed, by the divergence theorem; negative if inside out
  std::size_t zero_area = 0;  ///< triangles whose area is zero to rounding
  std::size_t duplicate_nodes = 0;
  std::size_t orphan_nodes = 0;         ///< nodes in no triangle
  std::size_t duplicate_triangles = 0;  ///< triangles with the nodes of an earlier one
  SurfaceTopology topology;

  /** True if it bounds a volume: closed, manifold, consistently outward. */
  bool watertight() const;
};

/** Checks a triangle mesh; changes nothing. */
SurfaceCheck checkSurface(const TriMesh& mesh);

/** A report for people, a line per fact, problems marked. */
std::string toText(const MeshCheck& check);

/** A report for people, a line per fact, problems marked. */
std::string toText(const SurfaceCheck& check);

/** How the triangles of a surface over `node_count` nodes hang together. */
SurfaceTopology surfaceTopology(Index node_count, const std::vector<Triangle>& triangles);

}  // namespace soft_tissue
