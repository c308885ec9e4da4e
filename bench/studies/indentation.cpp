#include "indentation.h"

#include <algorithm>
#include <cmath>

#include "indented_block.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"
#include "turned_surface.h"

namespace soft_tissue::studies
{
namespace
{
constexpr int kSteps = 5;
constexpr double kAbove = 0.002;  // of the contact radius, where the tool starts
constexpr int kAround = 96;

double reduced(const Indentation& problem)
{
  return problem.young_modulus_pa / (1.0 - problem.poisson_ratio * problem.poisson_ratio);
}

TetMesh makeBlock(const Indentation& problem, const IndentationMesh& spec)
{
  const double radius = problem.contactRadius(), reach = problem.block * radius;
  return spec.around > 0 ? blockAroundEdge(spec.around, radius, reach)
                         : blockAroundTip(spec.cells, spec.growth, reach);
}

/** The tool with its tip at its frame's origin. */
ShapeConfig toolShape(const Indentation& problem, const std::string& folder)
{
  if (problem.shape == Indentation::Shape::sphere)
  {
    ShapeConfig ball{SphereShape{problem.radius_m}, {}};
    ball.origin.position_m = Vec3(0.0, 0.0, problem.radius_m);
    return ball;
  }
  const double radius =
      problem.shape == Indentation::Shape::punch ? problem.radius_m : 4.0 * problem.contactRadius();
  const double height = radius / std::tan(problem.half_angle);
  const Points line =
      problem.shape == Indentation::Shape::punch
          ? Points{{0, 0, 0}, {radius, 0, 0}, {radius, 0, 4 * radius}, {0, 0, 4 * radius}}
          : Points{{0, 0, 0}, {radius, 0, height}, {0, 0, height}};
  MeshShape shape;
  shape.mesh.file = folder + "/indenter.stl";
  saveStl(shape.mesh.file, turnedSurface(line, kAround, false));
  return {shape, {}};
}

SceneConfig makeScene(const Indentation& problem, const IndentationMesh& mesh,
                      const std::string& folder)
{
  const double reach = problem.block * problem.contactRadius();
  SceneConfig config;
  config.file = "indentation";
  config.gravity_m_per_s2.setZero();
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-4;
  config.solver.max_iterations = 60;
  TissueConfig tissue;
  tissue.name = "block";
  tissue.element = mesh.element;
  tissue.mesh.file = folder + "/block.msh";
  saveGmsh(tissue.mesh.file, makeBlock(problem, mesh));
  tissue.material = {MaterialModel::neo_hookean, problem.young_modulus_pa, problem.poisson_ratio,
                     1000.0};
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -reach * (1.0 - 1e-6))});
  config.tissues.push_back(tissue);
  ToolConfig tool;
  tool.name = "indenter";
  tool.shapes.push_back(toolShape(problem, folder));
  tool.initial_pose.position_m = Vec3(0.0, 0.0, kAbove * problem.contactRadius());
  config.tools.push_back(tool);
  ContactConfig contact;
  contact.tissue = tissue.name;
  contact.other = tool.name;
  contact.response = mesh.response;
  contact.stiffness_pa_per_m = mesh.stiffness * problem.young_modulus_pa / problem.contactRadius();
  config.contacts.push_back(contact);
  return config;
}
}  // namespace

double Indentation::contactRadius() const
{
  switch (shape)
  {
    case Shape::sphere:
      return std::sqrt(radius_m * depth_m);
    case Shape::punch:
      return radius_m;
    case Shape::cone:
      break;
  }
  return 2.0 / M_PI * std::tan(half_angle) * depth_m;
}

double Indentation::force() const
{
  switch (shape)
  {
    case Shape::sphere:
      return 4.0 / 3.0 * reduced(*this) * contactRadius() * depth_m;
    case Shape::punch:
      return 2.0 * reduced(*this) * radius_m * depth_m;
    case Shape::cone:
      break;
  }
  return reduced(*this) * contactRadius() * depth_m;
}

double Indentation::shareWithin(double share) const
{
  const double beyond = std::sqrt(1.0 - share * share);
  switch (shape)
  {
    case Shape::sphere:
      return 1.0 - beyond * beyond * beyond;
    case Shape::punch:
      return 1.0 - beyond;
    case Shape::cone:
      break;
  }
  return share * share * std::acosh(1.0 / share) + 1.0 - beyond;
}

IndentationResult indent(const Indentation& problem, const IndentationMesh& mesh,
                         const std::string& folder)
{
  const Timer timer;
  Scene scene(makeScene(problem, mesh, folder));
  IndentationResult result;
  for (int k = 1; k <= kSteps; ++k)
  {
    Pose X_WT = Pose::Identity();
    X_WT.translation().z() = -problem.depth_m * k / kSteps;
    scene.setToolTarget(0, X_WT);
    const StepReport& report = scene.step();
    result.newton_iterations += report.newton_iterations;
    result.converged = result.converged && report.converged && !report.held;
  }
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const ToolState& tool = snapshot.tools.at(0);
  const Vec3& force = tool.wrench_W.force;
  result.force = force.z();
  result.across = std::hypot(force.x(), force.y());
  for (const ContactPoint& point : tool.contacts)
  {
    const double radius = std::hypot(point.position_W.x(), point.position_W.y());
    result.radius_m = std::max(result.radius_m, radius);
    result.force_within_half += radius < 0.5 * problem.contactRadius() ? point.force_W.z() : 0.0;
  }
  const TissueInfo& block = scene.tissues().at(0);
  result.tets = block.rest.tets.size();
  result.nodes = block.rest.nodes.size();
  result.element_m = mesh.around > 0
                         ? problem.contactRadius() * kEdgeCell / mesh.around
                         : problem.block * problem.contactRadius() *
                               std::sinh(mesh.growth / mesh.cells) / std::sinh(mesh.growth);
  result.penetration_m = snapshot.report.max_penetration_m;
  result.seconds = timer.seconds();
  return result;
}

}  // namespace soft_tissue::studies
