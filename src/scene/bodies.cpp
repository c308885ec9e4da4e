#include "bodies.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "element_choice.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/geometry/halving_order.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"

namespace soft_tissue
{
namespace
{
std::string indexed(const std::string& where, const char* key, std::size_t index)
{
  return where + "." + key + "[" + std::to_string(index) + "]";
}

/** @throws Error if there are none; `where` names the box */
std::vector<Index> nodesIn(const BoxConfig& box, const Points& nodes, const std::string& where)
{
  std::vector<Index> found;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    if ((nodes[i].array() >= box.min.array()).all() && (nodes[i].array() <= box.max.array()).all())
    {
      found.push_back(static_cast<Index>(i));
    }
  }
  if (found.empty())
  {
    throw Error(where + ".box_m holds no node of the mesh");
  }
  return found;
}

std::vector<Index> fixedNodes(const SoftBodyConfig& config, const Points& nodes,
                              const std::string& where)
{
  std::vector<Index> all;
  for (std::size_t k = 0; k < config.fixed.size(); ++k)
  {
    const std::vector<Index> found = nodesIn(config.fixed[k], nodes, indexed(where, "fixed", k));
    all.insert(all.end(), found.begin(), found.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/** Nodes that key frames move; each in one way only. */
std::vector<std::vector<Index>> movedNodes(const SoftBodyConfig& config, const TissueInfo& info,
                                           const std::string& where)
{
  std::vector<char> held(info.rest.nodes.size(), 0);
  for (const Index node : info.fixed_nodes)
  {
    held[node] = 1;
  }
  std::vector<std::vector<Index>> moved;
  for (std::size_t k = 0; k < config.keyframes.size(); ++k)
  {
    const std::string name = indexed(where, "keyframes", k) + ".nodes";
    moved.push_back(nodesIn(config.keyframes[k].nodes, info.rest.nodes, name));
    for (const Index node : moved.back())
    {
      if (held[node] != 0)
      {
        throw Error(name + ".box_m holds nodes that are fixed, or moved by other key frames");
      }
      held[node] = 1;
    }
  }
  return moved;
}

void applyRegions(const TissueConfig& config, const std::string& where, TissueModel& model)
{
  const std::vector<int>& tags = model.quadratic ? model.quadratic->tags : model.info.rest.tags;
  for (std::size_t k = 0; k < config.regions.size(); ++k)
  {
    const RegionConfig& region = config.regions[k];
    if (std::find(tags.begin(), tags.end(), region.tag) == tags.end())
    {
      throw Error(indexed(where, "regions", k) + ".tag = " + std::to_string(region.tag) +
                  ": no tet of the mesh has this tag");
    }
    for (std::size_t t = 0; t < tags.size(); ++t)
    {
      if (tags[t] == region.tag)
      {
        model.stiffness[t].young_modulus =
            region.young_modulus_pa.value_or(model.stiffness[t].young_modulus);
        model.stiffness[t].poisson_ratio =
            region.poisson_ratio.value_or(model.stiffness[t].poisson_ratio);
        model.stiffness[t].stiffening = region.stiffening.value_or(model.stiffness[t].stiffening);
        model.laws[t] = region.model.value_or(model.laws[t]);
        model.densities[t] = region.density_kg_per_m3.value_or(model.densities[t]);
      }
    }
  }
}

std::shared_ptr<const RigidShape> makeShape(const ShapeGeometry& geometry, const std::string& where)
{
  if (const auto* sphere = std::get_if<SphereShape>(&geometry))
  {
    return makeSphere(sphere->radius_m);
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&geometry))
  {
    return makeCapsule(capsule->radius_m, capsule->length_m);
  }
  if (const auto* box = std::get_if<BoxShape>(&geometry))
  {
    return makeBox(box->size_m);
  }
  const MeshShape& shape = std::get<MeshShape>(geometry);
  TriMesh mesh = loadTriMesh(shape.mesh.file, shape.mesh.metres_per_unit).mesh;
  for (Vec3& p : mesh.nodes)
  {
    p = p.cwiseProduct(shape.scale);
  }
  if (shape.scale.prod() < 0.0)
  {
    for (Triangle& t : mesh.triangles)
    {
      std::swap(t[1], t[2]);
    }
  }
  return makeMeshShape(mesh.nodes, mesh.triangles, where + " (" + shape.mesh.file + ")");
}

/** What the mesh in use has otherwise than its file, and what of it is of no use: a line each. */
std::vector<std::string> remarksOn(const std::string& file, const LoadReport& report)
{
  std::vector<std::string> remarks;
  if (report.ignored_elements > 0)
  {
    remarks.push_back(file + ": " + std::to_string(report.ignored_elements) +
                      " elements that are not tets left out");
  }
  for (const std::string& warning : report.warnings)
  {
    remarks.push_back(file + ": " + warning);
  }
  return remarks;
}

/** What a body is by its mesh alone; of a membrane the tets are none. */
TissueInfo infoOf(const SoftBodyConfig& config, TetMesh mesh, const LoadReport& report)
{
  TissueInfo info;
  info.name = config.name;
  info.remarks = remarksOn(config.mesh.file, report);
  info.rest = std::move(mesh);
  const Pose X_WB = config.pose.toPose();
  for (Vec3& p : info.rest.nodes)
  {
    p = X_WB * p;
  }
  return info;
}

std::vector<Index> inverse(const std::vector<Index>& numbers)
{
  std::vector<Index> places(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    places[numbers[i]] = static_cast<Index>(i);
  }
  return places;
}

/** With new numbers for all nodes. */
TetMesh renumbered(const TetMesh& mesh, const std::vector<Index>& numbers)
{
  TetMesh result = mesh;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    result.nodes[numbers[i]] = mesh.nodes[i];
  }
  for (Tet& tet : result.tets)
  {
    for (Index& node : tet)
    {
      node = numbers[node];
    }
  }
  return result;
}

void hold(const SoftBodyConfig& config, const std::string& where, SoftBodyModel& model)
{
  model.info.fixed_nodes = fixedNodes(config, model.info.rest.nodes, where);
  model.moved = movedNodes(config, model.info, where);
}
}  // namespace

TissueModel makeTissue(const TissueConfig& config, const std::string& where)
{
  TissueModel model;
  LoadedTetMesh loaded = loadTetMesh(config.mesh.file, config.mesh.metres_per_unit);
  model.file_node = halvingOrder(loaded.mesh.nodes);
  model.info = infoOf(config, renumbered(loaded.mesh, inverse(model.file_node)), loaded.report);
  TetMesh& rest = model.info.rest;
  for (std::size_t t = 0; t < rest.tets.size(); ++t)
  {
    const Tet& tet = rest.tets[t];
    if (!(signedVolume6(rest.nodes[tet[0]], rest.nodes[tet[1]], rest.nodes[tet[2]],
                        rest.nodes[tet[3]]) > 0.0))
    {
      throw Error(config.mesh.file + ": tet " + std::to_string(t) +
                  " has no volume, can't be simulated; `mesh_tool repair` removes such tets");
    }
  }
  const std::size_t elements = rest.tets.size();
  model.element = elementOf(config, elements);
  if (model.element == ElementKind::tet10)
  {
    model.quadratic = withEdgeNodes(rest);
    rest = subdivided(*model.quadratic);
    for (std::size_t node = model.file_node.size(); node < rest.nodes.size(); ++node)
    {
      model.file_node.push_back(static_cast<Index>(node));
    }
  }
  model.info.surface = extractBoundary(static_cast<Index>(rest.nodes.size()), rest.tets);
  hold(config, where, model);
  const MaterialConfig& material = config.material;
  TetStiffnessParameters stiffness = {material.young_modulus_pa, material.poisson_ratio};
  stiffness.stiffening = material.stiffening.value_or(stiffness.stiffening);
  model.laws.assign(elements, material.model);
  model.stiffness.assign(elements, stiffness);
  model.densities.assign(elements, material.density_kg_per_m3);
  applyRegions(config, where, model);
  return model;
}

SoftBodyModel makeMembrane(const MembraneConfig& config, const std::string& where)
{
  SoftBodyModel model;
  LoadedMesh loaded = loadMesh(config.mesh.file, config.mesh.metres_per_unit);
  if (!loaded.volume.tets.empty())
  {
    throw Error(config.mesh.file + " has tets, a membrane must be a mesh of triangles");
  }
  const std::vector<Triangle>& triangles = loaded.surface.triangles;
  if (triangles.empty())
  {
    throw Error(config.mesh.file + " has no triangles, a membrane needs some");
  }
  model.info = infoOf(config, {std::move(loaded.surface.nodes), {}, {}}, loaded.report);
  const Points& nodes = model.info.rest.nodes;
  model.file_node.resize(nodes.size());
  std::iota(model.file_node.begin(), model.file_node.end(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const Vec3& a = nodes[triangles[t][0]];
    if (!((nodes[triangles[t][1]] - a).cross(nodes[triangles[t][2]] - a).norm() > 0.0))
    {
      throw Error(config.mesh.file + ": triangle " + std::to_string(t) +
                  " has no area, can't be simulated");
    }
  }
  model.info.surface = surfaceOf(static_cast<Index>(nodes.size()), triangles);
  hold(config, where, model);
  return model;
}

TissueInfo inFileOrder(const SoftBodyModel& model)
{
  TissueInfo info = model.info;
  if (info.isMembrane())
  {
    return info;
  }
  info.rest = renumbered(info.rest, model.file_node);
  info.surface = extractBoundary(static_cast<Index>(info.rest.nodes.size()), info.rest.tets);
  for (Index& node : info.fixed_nodes)
  {
    node = model.file_node[node];
  }
  std::sort(info.fixed_nodes.begin(), info.fixed_nodes.end());
  return info;
}

void addMasses(const TissueModel& model, Index first_node, std::vector<double>& masses,
               std::vector<double>& load_masses)
{
  if (!model.quadratic)
  {
    addLumpedMasses(model.info.rest, model.densities, first_node, masses);
    addLumpedMasses(model.info.rest, model.densities, first_node, load_masses);
    return;
  }
  addLumpedMasses(*model.quadratic, model.densities, first_node, masses);
  if (model.info.fixed_nodes.empty() && model.moved.empty())
  {
    addLumpedMasses(*model.quadratic, model.densities, first_node, load_masses);
  }
  else
  {
    addLoadMasses(*model.quadratic, model.densities, first_node, load_masses);
  }
}

Adjacency elementNeighbours(const TissueModel& model)
{
  const auto count = static_cast<Index>(model.info.rest.nodes.size());
  return model.quadratic ? nodeNeighbours(count, model.quadratic->elements)
                         : nodeNeighbours(count, model.info.rest.tets);
}

std::string item(const SceneConfig& config, const char* list, std::size_t index)
{
  return config.file + ": " + list + "[" + std::to_string(index) + "]";
}

double edgeLength(const TissueInfo& tissue, double share)
{
  std::vector<double> lengths;
  for (const Edge& edge : tissue.surface.edges)
  {
    lengths.push_back((tissue.rest.nodes[edge[1]] - tissue.rest.nodes[edge[0]]).norm());
  }
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(lengths.size() - 1));
  std::nth_element(lengths.begin(), lengths.begin() + rank, lengths.end());
  return lengths[rank];
}

double innerRadius(const TetMesh& rest, const BoundarySurface& surface)
{
  TriangleTree tree;
  tree.build(surface.triangles, rest.nodes);
  double squared = 0.0;
  Index hint = -1;
  const auto consider = [&](const Vec3& p) {
    const TriangleTree::Nearest nearest = tree.nearest(p, rest.nodes, hint);
    hint = nearest.triangle;
    squared = std::max(squared, nearest.point.squared_distance);
  };
  for (const Tet& tet : rest.tets)
  {
    Vec3 middle = Vec3::Zero();
    for (const Index node : tet)
    {
      middle += 0.25 * rest.nodes[node];
    }
    consider(middle);
  }
  std::for_each(rest.nodes.begin(), rest.nodes.end(), consider);
  return std::sqrt(squared);
}

std::vector<ToolPartModel> makeToolParts(const ToolConfig& config, const std::string& where)
{
  const Linkage& linkage = config.linkage;
  const JointValues any =
      JointValues::Zero(static_cast<Eigen::Index>(linkage.coordinates().size()));
  std::vector<ToolPartModel> parts;
  for (std::size_t k = 0; k < config.shapes.size(); ++k)
  {
    const ShapeConfig& shape = config.shapes[k];
    const std::string name =
        config.shapes.size() > 1 ? indexed(where, "shapes", k) : where + ".shape";
    const std::size_t carrier = linkage.carrier(shape.link);
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const ToolPartModel& one) { return one.link == carrier; });
    if (part == parts.end())
    {
      const std::string& link = linkage.links()[shape.link].name;
      part = parts.insert(parts.end(), {link.empty() ? config.name : link, carrier, {}});
    }
    part->shape.add(makeShape(shape.geometry, name),
                    linkage.pose(carrier, shape.link, any) * shape.origin.toPose());
  }
  if (parts.empty())
  {
    throw Error(where + " has no shape");
  }
  return parts;
}

}  // namespace soft_tissue
