#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "soft_tissue_sim/contact/tool_contact.h"
#include "soft_tissue_sim/geometry/closest_point.h"
#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
/** A box of nx x ny x nz cubes from `low` to `high`, six tets around the diagonal of each. */
inline TetMesh slab(const Vec3& low, const Vec3& high, int nx, int ny, int nz)
{
  TetMesh mesh;
  const auto node = [&](int i, int j, int k) { return Index((k * (ny + 1) + j) * (nx + 1) + i); };
  for (int k = 0; k <= nz; ++k)
  {
    for (int j = 0; j <= ny; ++j)
    {
      for (int i = 0; i <= nx; ++i)
      {
        const Vec3 part(double(i) / nx, double(j) / ny, double(k) / nz);
        mesh.nodes.push_back(low + part.cwiseProduct(high - low));
      }
    }
  }
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int k = 0; k < nz; ++k)
  {
    for (int j = 0; j < ny; ++j)
    {
      for (int i = 0; i < nx; ++i)
      {
        for (const auto& order : kOrders)
        {
          std::array<int, 3> at = {i, j, k};
          Tet tet;
          tet[0] = node(at[0], at[1], at[2]);
          for (int step = 0; step < 3; ++step)
          {
            ++at[order[step]];
            tet[step + 1] = node(at[0], at[1], at[2]);
          }
          if (signedVolume6(mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]],
                            mesh.nodes[tet[3]]) < 0.0)
          {
            std::swap(tet[2], tet[3]);
          }
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  mesh.tags.assign(mesh.tets.size(), 0);
  return mesh;
}

/** Nodal depths and closest triangles by trying every triangle for every node. */
class ExhaustiveField : public DistanceField
{
 public:
  explicit ExhaustiveField(const BoundarySurface& surface, int* marches = nullptr)
      : surface_(surface), marches_(marches)
  {}

  void march(const Points& x) override
  {
    std::vector<Index> all(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      all[i] = Index(i);
    }
    marchUntil(x, all);
  }

  std::uint64_t evaluations() const override { return 0; }
  void exchange(StateArchive&) override {}

  void marchUntil(const Points& x, const std::vector<Index>& wanted) override
  {
    if (marches_ != nullptr)
    {
      ++*marches_;
    }
    depth_.assign(x.size(), std::numeric_limits<double>::quiet_NaN());
    closest_.assign(x.size(), -1);
    for (const Index node : wanted)
    {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      {
        const Triangle& n = surface_.triangles[t];
        const double squared =
            closestOnTriangle(x[node], x[n[0]], x[n[1]], x[n[2]]).squared_distance;
        if (squared < least)
        {
          least = squared;
          closest_[node] = Index(t);
        }
      }
      depth_[node] = std::sqrt(least);
    }
  }

  const std::vector<double>& depth() const override { return depth_; }
  const std::vector<Index>& closestTriangle() const override { return closest_; }

 private:
  const BoundarySurface& surface_;
  int* marches_;
  std::vector<double> depth_;
  std::vector<Index> closest_;
};

/** A tissue with one tool in it; `marches` counts how often its field was marched. */
struct ContactScene
{
  TetMesh mesh;
  BoundarySurface surface;
  Adjacency node_neighbours;
  RigidBodyShape tool;
  std::unique_ptr<ToolContact> contact;
  int marches = 0;

  ContactScene(const TetMesh& tissue, std::shared_ptr<const RigidShape> shape,
               const ContactOptions& options)
      : mesh(tissue),
        surface(extractBoundary(Index(mesh.nodes.size()), mesh.tets)),
        node_neighbours(nodeNeighbours(Index(mesh.nodes.size()), mesh.tets))
  {
    tool.add(std::move(shape), Pose::Identity());
    const TissueBody body = {&mesh.tets, &surface, 0, Index(mesh.nodes.size())};
    contact = std::make_unique<ToolContact>(
        body, tool, std::make_unique<ExhaustiveField>(surface, &marches), options);
  }
  ContactScene(const ContactScene&) = delete;
  ContactScene& operator=(const ContactScene&) = delete;

  /** A step from x with the tool at rest at X_WT. */
  void begin(const Points& x, const Pose& X_WT) { contact->beginStep(x, X_WT, X_WT, true); }
};

/** Adds the force of the tissue on the tool, N, and its moment about `reference`, N m. */
inline void addToolWrench(const std::vector<ContactSample>& samples, const Vec3& reference,
                          Vec3& force, Vec3& torque)
{
  for (const ContactSample& s : samples)
  {
    force += s.forceOnFirst();
    torque += (s.position - reference).cross(s.forceOnFirst());
  }
}

inline Pose at(const Vec3& position)
{
  Pose X = Pose::Identity();
  X.translation() = position;
  return X;
}

/** The nodes, each moved by up to `size` along every axis. */
inline Points shaken(Points x, double size, unsigned seed)
{
  RandomGeometry random(seed);
  for (Vec3& p : x)
  {
    p += random.point(size);
  }
  return x;
}

/** The four combinations of response and depth. */
inline std::vector<ContactOptions> contactModels(double stiffness)
{
  std::vector<ContactOptions> all;
  for (const bool segments : {false, true})
  {
    for (const bool closest : {false, true})
    {
      ContactOptions options;
      options.segments = segments;
      options.closest_feature = closest;
      options.stiffness_pa_per_m = stiffness;
      all.push_back(options);
    }
  }
  return all;
}

inline std::string nameOf(const ContactOptions& options)
{
  return std::string(options.segments ? "segments" : "points") +
         (options.closest_feature ? ", closest feature" : ", interpolated");
}

}  // namespace soft_tissue::test
