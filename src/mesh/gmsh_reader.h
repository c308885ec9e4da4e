#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "mesh_builder.h"

namespace soft_tissue
{
/** Reads Gmsh .msh files, one method per section and version. */
class GmshReader
{
 public:
  GmshReader(FileCursor& cursor, double metres_per_unit)
      : cursor_(cursor), builder_(cursor, metres_per_unit)
  {}

  LoadedMesh read();

 private:
  void readHeader();
  bool readSection(std::string_view name);
  void readFlatNodes();
  void readElements1();
  void readElements2();
  void readElements2Binary();
  void readEntities4();
  void readNodes4();
  void readElements4();

  void addNode(long long number, double x, double y, double z);
  void addElement(int type, const std::vector<long long>& numbers, int tag);
  /** Nodes of an element of this type. @throws Error on a type Gmsh does not have */
  int nodesOfType(long long type) const;

  FileCursor& cursor_;
  MeshBuilder builder_;
  int version_ = 1;
  bool binary_ = false;
  bool have_nodes_ = false;
  bool have_elements_ = false;
  std::unordered_map<long long, long long> index_of_;  ///< node index of a node number
  std::map<int, int> volume_tag_;  ///< physical tag of a volume entity, version 4
};

}  // namespace soft_tissue
