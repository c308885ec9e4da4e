#pragma once

#include <cmath>
#include <memory>

#include "soft_tissue_sim/contact/tissue_contact.h"
#include "support/contact_scene.h"

namespace soft_tissue::test
{
/** A body among others: its mesh, and where its nodes stand. */
struct PairedBody
{
  TetMesh mesh;
  BoundarySurface surface;
  Index first_node;

  PairedBody(const TetMesh& tissue, Index first)
      : mesh(tissue),
        surface(extractBoundary(Index(mesh.nodes.size()), mesh.tets)),
        first_node(first)
  {}
  PairedBody(const PairedBody&) = delete;
  PairedBody& operator=(const PairedBody&) = delete;

  Index size() const { return Index(mesh.nodes.size()); }

  TissueContact::Side side(double short_edge) const
  {
    TissueBody body = {&mesh.tets, &surface, first_node, size()};
    body.short_edge = short_edge;
    body.rest = &mesh.nodes;
    return {body, std::make_unique<ExhaustiveField>(surface)};
  }
};

/** Two bodies and their contact; x holds the nodes of the first, then those of the second. */
struct TissuePair
{
  PairedBody first, second;
  Points x;
  Adjacency neighbours;
  std::unique_ptr<TissueContact> contact;

  TissuePair(const TetMesh& a, const TetMesh& b, const ContactOptions& options,
             double short_edge = 0.004)
      : first(a, 0), second(b, Index(a.nodes.size())), x(a.nodes)
  {
    x.insert(x.end(), b.nodes.begin(), b.nodes.end());
    std::vector<Tet> tets = a.tets;
    for (Tet tet : b.tets)
    {
      for (Index& node : tet)
      {
        node += first.size();
      }
      tets.push_back(tet);
    }
    neighbours = nodeNeighbours(Index(x.size()), tets);
    contact =
        std::make_unique<TissueContact>(first.side(short_edge), second.side(short_edge), options);
  }
};

/** One body and its contact with itself. */
struct SelfContact
{
  PairedBody body;
  Adjacency neighbours;
  std::unique_ptr<TissueContact> contact;

  SelfContact(const TetMesh& mesh, const ContactOptions& options, double short_edge = 0.004)
      : body(mesh, 0),
        neighbours(nodeNeighbours(body.size(), mesh.tets)),
        contact(std::make_unique<TissueContact>(body.side(short_edge), options))
  {}
};

/** Nodes of a bar along x, its length rolled up once and a little more; each turn goes out by
 * `pitch`, m. Less than its height makes it go through itself. */
inline Points rolledUp(const Points& bar, double length, double pitch, double turns = 1.15)
{
  constexpr double kPi = 3.14159265358979323846;
  const double angle = 2.0 * kPi * turns;
  Points rolled;
  for (const Vec3& p : bar)
  {
    const double part = angle * p.x() / length;
    const double radius = length / angle + p.z() + pitch * part / (2.0 * kPi);
    rolled.emplace_back(radius * std::sin(part), p.y(), radius * std::cos(part));
  }
  return rolled;
}

/** Sum of forces and of their moments about the origin that a term puts on nodes, N and N m. */
struct NodalSums
{
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_size = 0.0, moment_size = 0.0;

  NodalSums(EnergyTerm& term, const Points& x)
  {
    Points gradient(x.size(), Vec3::Zero());
    term.addGradient(x, gradient);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      force -= gradient[i];
      moment -= x[i].cross(gradient[i]);
      force_size += gradient[i].norm();
      moment_size += x[i].cross(gradient[i]).norm();
    }
  }
};

}  // namespace soft_tissue::test
