#include "fem_error.h"

#include <algorithm>
#include <cmath>

#include "cook_membrane.h"
#include "fem_table.h"
#include "plain_fem.h"
#include "sagging_beam.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/scene/scene.h"
#include "timing.h"

namespace soft_tissue::studies
{
namespace
{
constexpr LinearSolverKind kLinearSolvers[] = {LinearSolverKind::automatic,
                                               LinearSolverKind::cholesky};
constexpr ElementKind kElements[] = {ElementKind::tet4, ElementKind::tet4_anp, ElementKind::tet10};
constexpr int kMostTurns = 3;
constexpr double kLongTurn = 0.5;  // s, of the thread: no more turns after one

/** How long a beam sags. */
struct Sag
{
  double gravity_m_per_s2;
  int steps;  ///< 0: static
};

/** A way of the tip, m, and the time it took. */
struct SagResult
{
  Vec3 tip = Vec3::Zero();
  FemResult result;
};

SagResult sag(const FemChoice& choice, const Sag& how, const std::string& mesh)
{
  BeamSetup setup;
  setup.mesh = mesh;
  setup.element = choice.element;
  setup.law = choice.law;
  setup.gravity_m_per_s2 = how.gravity_m_per_s2;
  setup.solver.stepper = how.steps == 0 ? Stepper::quasi_static : Stepper::implicit_euler;
  setup.solver.linear = choice.linear;
  setup.solver.tolerance = choice.tolerance;
  setup.solver.max_iterations = 200;
  const SceneConfig config = beamScene(setup);
  Scene scene(config);
  SagResult sagged;
  std::vector<double> seconds;
  for (int turn = 0; turn < kMostTurns && (turn == 0 || seconds.back() < kLongTurn); ++turn)
  {
    scene.resetWorld();
    sagged.result.converged = true;
    const double start = threadSeconds();
    for (int k = 0; k < std::max(how.steps, 1); ++k)
    {
      const StepReport& report = scene.step();
      sagged.result.converged = sagged.result.converged && report.converged && !report.held;
    }
    seconds.push_back(threadSeconds() - start);
  }
  const double simulated = how.steps == 0 ? 1.0 : how.steps * config.time_step_s;
  const TetMesh& rest = scene.tissues()[0].rest;
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  sagged.tip = meanWay(beamTip(rest.nodes), rest.nodes, snapshot.tissues[0].positions);
  sagged.result.ms = 1e3 * median(seconds) / simulated;
  sagged.result.tets = rest.tets.size() / (choice.element == ElementKind::tet10 ? kTetParts : 1);
  sagged.result.nodes = rest.nodes.size();
  return sagged;
}

void addTo(FemTable& table, const FemChoice& choice, SagResult sagged, const Vec3& reference)
{
  sagged.result.found = 1e3 * sagged.tip.norm();
  sagged.result.error = (sagged.tip - reference).norm() / reference.norm();
  table.add(choice, sagged.result);
}

/** Elements, laws, linear solvers and meshes, against quadratic tets on the finest mesh. */
void compareMeshes(FemTable& table, const std::string& folder, const Sag& how, bool quick)
{
  const std::vector<MaterialModel> laws =
      quick ? std::vector<MaterialModel>{MaterialModel::neo_hookean}
            : std::vector<MaterialModel>{MaterialModel::neo_hookean, MaterialModel::neo_hookean_log,
                                         MaterialModel::corotated};
  using Sizes = std::vector<int>;
  for (const MaterialModel law : laws)
  {
    FemChoice best;
    best.element = ElementKind::tet10;
    best.law = law;
    best.tolerance = 1e-7;
    const SagResult reference = sag(best, how, beamMesh(folder, quick ? 1 : 5));
    if (!reference.result.converged)
    {
      throw Error("the beam to compare with did not converge");
    }
    for (const ElementKind element : kElements)
    {
      const Sizes sizes = quick                           ? Sizes{0}
                          : element == ElementKind::tet10 ? Sizes{0, 1, 2}
                                                          : Sizes{1, 5, 20};
      for (const LinearSolverKind linear : kLinearSolvers)
      {
        for (const int thousands : sizes)
        {
          const FemChoice choice{element, law, linear, SolverConfig().tolerance};
          addTo(table, choice, sag(choice, how, beamMesh(folder, thousands)), reference.tip);
        }
      }
    }
  }
}

/** What less exact solutions and a plain step are off after a while, on the same mesh. */
void compareTolerances(FemTable& table, const Sag& how, const std::string& mesh)
{
  for (const MaterialModel law : {MaterialModel::neo_hookean, MaterialModel::corotated})
  {
    FemChoice exact;
    exact.law = law;
    exact.tolerance = 1e-8;
    const SagResult reference = sag(exact, how, mesh);
    for (const LinearSolverKind linear : kLinearSolvers)
    {
      for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4})
      {
        if (linear == LinearSolverKind::cholesky && tolerance != 1e-3)
        {
          continue;
        }
        const FemChoice choice{ElementKind::tet4, law, linear, tolerance};
        addTo(table, choice, sag(choice, how, mesh), reference.tip);
      }
    }
    if (law != MaterialModel::corotated)
    {
      continue;
    }
    BeamSetup setup;
    setup.mesh = mesh;
    const SceneConfig config = beamScene(setup);
    const TetMesh rest = Scene(config).tissues()[0].rest;
    const MaterialConfig& material = config.tissues[0].material;
    for (const int linearisations : {1, 2, 5})
    {
      PlainFem::Options options;
      options.gravity = Vec3(0.0, -how.gravity_m_per_s2, 0.0);
      options.linearisations = linearisations;
      options.tolerance = 0.0;
      PlainFem plain(rest, clampedNodes(rest.nodes),
                     {material.young_modulus_pa, material.poisson_ratio},
                     material.density_kg_per_m3, options);
      const double start = threadSeconds();
      for (int k = 0; k < how.steps; ++k)
      {
        plain.step();
      }
      SagResult sagged;
      sagged.result.ms = 1e3 * (threadSeconds() - start) / (how.steps * config.time_step_s);
      sagged.result.other = "plain " + std::to_string(linearisations);
      sagged.result.tets = rest.tets.size();
      sagged.result.nodes = rest.nodes.size();
      sagged.tip = meanWay(beamTip(rest.nodes), rest.nodes, plain.positions());
      addTo(table, {ElementKind::tet4, law}, sagged, reference.tip);
    }
  }
}

/** Where linear tets lock. */
void compareWithCook(FemTable& table, bool quick)
{
  struct Published
  {
    const char* name;
    double poisson_ratio, deflection;
  };
  for (const Published& row : {Published{"cook 1/3", 1.0 / 3.0, 21.522},
                               {"cook 0.45", 0.45, 19.574},
                               {"cook 0.49", 0.49, 18.718},
                               {"cook 0.4999", 0.4999, 18.483}})
  {
    for (const MaterialModel law : {MaterialModel::neo_hookean, MaterialModel::corotated})
    {
      for (const LinearSolverKind linear :
           {LinearSolverKind::automatic, LinearSolverKind::pcg, LinearSolverKind::cholesky})
      {
        for (const ElementKind element : kElements)
        {
          const int first = quick ? 2 : element == ElementKind::tet10 ? 4 : 8;
          const int last = quick ? 4 : element == ElementKind::tet4_anp ? 8 * first : 4 * first;
          for (int cells = first; cells <= last; cells *= 2)
          {
            const FemChoice choice{element, law, linear, SolverConfig().tolerance};
            FemResult result = cookMembrane(choice, cells, row.poisson_ratio);
            result.error = std::abs(result.found / row.deflection - 1.0);
            table.add(choice, result);
          }
        }
      }
    }
    table.finishCase(row.name);
  }
}
}  // namespace

void studyFemError(const std::string& folder, bool quick)
{
  setThreadCount(1);
  FemTable table(folder);
  compareWithCook(table, quick);
  compareMeshes(table, folder, {0.981, 0}, quick);
  table.finishCase("sag");
  compareTolerances(table, {9.81, quick ? 20 : 200}, beamMesh(folder, quick ? 0 : 5));
  table.finishCase("heavy");
  compareMeshes(table, folder, {0.981, quick ? 5 : 30}, quick);
  table.finishCase("fall");
}

}  // namespace soft_tissue::studies
