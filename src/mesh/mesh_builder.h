#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "file_cursor.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue
{
/** Collects what a reader finds; checks each item where it stands in the file. */
class MeshBuilder
{
 public:
  /** @param index_base number of the first node in the file, for messages and addTet/addPolygon */
  MeshBuilder(FileCursor& cursor, double metres_per_unit, long long index_base = 0)
      : cursor_(&cursor), metres_per_unit_(metres_per_unit), index_base_(index_base)
  {}

  /** Goes on with another file of the same mesh. */
  void setCursor(FileCursor& cursor) { cursor_ = &cursor; }
  void setIndexBase(long long index_base) { index_base_ = index_base; }
  void setFormat(const std::string& format) { report_.format = format; }
  void warn(const std::string& sentence) { report_.warnings.push_back(sentence); }

  /** Adds a node, in file units. @throws Error if not finite or further than 1e6 m from the origin
   */
  void addNode(double x, double y, double z);
  std::size_t nodeCount() const { return nodes_.size(); }

  /** Adds a tet by file node numbers. @throws Error on an unknown or repeated node */
  void addTet(const std::array<long long, 4>& nodes, int tag);

  /**
   * Adds a quadratic tet by file node numbers, in QuadraticTet's order, as a tet of its vertices.
   * @throws Error on an unknown or repeated node, or one that is off the middle of its edge
   */
  void addQuadraticTet(const std::array<long long, 10>& nodes, int tag);

  /** Adds a polygon by file node numbers as a fan of triangles. @throws Error on an unknown node */
  void addPolygon(const std::vector<long long>& nodes);

  /** Notes a point or line element. */
  void addOther() { ++others_; }

  /** Refuses a volume element that is no tet. @throws Error always */
  [[noreturn]] void refuseVolumeElement(const std::string& kind) const;

  /** The finished mesh: its tets, or its triangles if it has no tet. @throws Error if it has
   * neither */
  LoadedMesh finish();

 private:
  Index checkedNode(long long number) const;
  void orientTets();
  void dropMiddles();
  void warnOfOddities();

  FileCursor* cursor_;
  double metres_per_unit_;
  long long index_base_;
  Points nodes_;
  std::vector<Tet> tets_;
  std::vector<int> tags_;
  std::vector<Index> middles_;  ///< of edges of quadratic tets, any number of times
  std::vector<Triangle> triangles_;
  std::size_t polygons_ = 0;
  std::size_t others_ = 0;
  LoadReport report_;
};

}  // namespace soft_tissue
