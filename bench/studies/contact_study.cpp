#include "contact_study.h"

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "contact_cost.h"
#include "detection_study.h"
#include "indentation.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue::studies
{
namespace
{
class ContactTable
{
 public:
  explicit ContactTable(const std::string& folder)
      : folder_(folder), path_(folder + "/contact.csv"), stream_(path_)
  {
    stream_ << "case,response,stiffness,tets,nodes,element_mm,force_n,reference_n,error,radius_mm,"
               "reference_radius_mm,mean_pressure_pa,reference_pressure_pa,penetration_mm,newton,"
               "converged,seconds\n";
    check();
  }

  void run(const std::string& name, const Indentation& problem, const IndentationMesh& mesh)
  {
    const IndentationResult got = indent(problem, mesh, folder_);
    const double reference = problem.force(), radius = problem.contactRadius();
    const double inner = 0.25 * M_PI * radius * radius;  // the area within half of that radius
    const char* response = mesh.response == Response::segment ? "segment" : "point";
    char line[400];
    std::snprintf(line, sizeof(line),
                  "%s,%s,%g,%zu,%zu,%.4g,%.6g,%.6g,%.4g,%.4g,%.4g,%.5g,%.5g,%.3g,%d,%d,%.3g\n",
                  name.c_str(), response, mesh.stiffness, got.tets, got.nodes, 1e3 * got.element_m,
                  got.force, reference, got.force / reference - 1.0, 1e3 * got.radius_m,
                  1e3 * radius, got.force_within_half / inner,
                  problem.shareWithin(0.5) * reference / inner, 1e3 * got.penetration_m,
                  got.newton_iterations, got.converged ? 1 : 0, got.seconds);
    stream_ << line << std::flush;
    check();
    std::printf(
        "%-26s %-7s kappa %5g E/a %7zu tets of %.3f a: force %+6.2f %%, radius %.2f of a, "
        "mean pressure within a/2 %+6.1f %%, %d Newton, %.1f s%s\n",
        name.c_str(), response, mesh.stiffness, got.tets, got.element_m / radius,
        100.0 * (got.force / reference - 1.0), got.radius_m / radius,
        100.0 * (got.force_within_half / (problem.shareWithin(0.5) * reference) - 1.0),
        got.newton_iterations, got.seconds, got.converged ? "" : ", not converged");
    std::fflush(stdout);
  }

 private:
  void check() const
  {
    if (!stream_)
    {
      throw Error(path_ + ": can't be written");
    }
  }

  std::string folder_, path_;
  std::ofstream stream_;
};
}  // namespace

void studyContact(const std::string& folder, bool quick)
{
  studyDetection(folder, quick);
  studyContactCost(folder, quick);
  using Shape = Indentation::Shape;
  struct Case
  {
    std::string name;
    Indentation problem;
  };
  Indentation hertz, stiffer, larger, shallow, punch, cone;
  stiffer.depth_m = 0.0005;
  stiffer.young_modulus_pa = 10000.0;
  stiffer.poisson_ratio = 0.49;
  larger.radius_m = 0.0127;
  larger.depth_m = 0.002;
  larger.young_modulus_pa = 15000.0;
  larger.poisson_ratio = 0.49;
  shallow.depth_m = 0.0001;
  shallow.poisson_ratio = 0.3;
  punch.shape = Shape::punch;
  punch.radius_m = 0.002;
  cone.shape = Shape::cone;
  const std::vector<int> sizes = quick ? std::vector<int>{6} : std::vector<int>{8, 12, 16, 20, 24};
  const std::string in_rings = " in rings";
  ContactTable table(folder);
  for (const Case& one :
       {Case{"hertz", hertz}, Case{"hertz nu 0.49", stiffer}, Case{"hertz large", larger},
        Case{"hertz shallow", shallow}, Case{"punch", punch}, Case{"cone", cone}})
  {
    for (const int cells : sizes)
    {
      IndentationMesh mesh;
      mesh.cells = cells;
      table.run(one.name, one.problem, mesh);
    }
    for (const int around : quick ? std::vector<int>{8} : std::vector<int>{8, 16, 24, 32, 40})
    {
      IndentationMesh mesh;
      mesh.around = around;
      table.run(one.name + in_rings, one.problem, mesh);
    }
    for (const int around : quick ? std::vector<int>{} : std::vector<int>{8, 12, 16})
    {
      IndentationMesh mesh;
      mesh.around = around;
      mesh.element = ElementKind::tet10;
      table.run(one.name + in_rings + " tet10", one.problem, mesh);
    }
  }
  // Mesh after mesh, as a scene has it: stiffness left to the scene, either response.
  for (const Response response : {Response::segment, Response::point})
  {
    for (const int cells : quick ? std::vector<int>{4} : std::vector<int>{4, 6, 10, 16})
    {
      IndentationMesh mesh;
      mesh.cells = cells;
      mesh.response = response;
      mesh.stiffness = kAutoStiffness * hertz.contactRadius() / hertz.radius_m;
      table.run("mesh by mesh", hertz, mesh);
    }
    // The same numbers of nodes in quadratic tets.
    for (const int cells : quick ? std::vector<int>{2} : std::vector<int>{2, 3, 5, 8})
    {
      IndentationMesh mesh;
      mesh.cells = cells;
      mesh.element = ElementKind::tet10;
      mesh.response = response;
      mesh.stiffness = kAutoStiffness * hertz.contactRadius() / hertz.radius_m;
      table.run("mesh by mesh tet10", hertz, mesh);
    }
    // A smaller block, so that coarse meshes have cells for the contact.
    Indentation small = hertz;
    small.block = 6.0;
    for (const int cells : quick ? std::vector<int>{3} : std::vector<int>{4, 5, 6, 8, 10})
    {
      IndentationMesh mesh;
      mesh.cells = cells;
      mesh.growth = 2.8;
      mesh.element = ElementKind::tet10;
      mesh.response = response;
      mesh.stiffness = 100.0;
      table.run("small block tet10", small, mesh);
    }
  }
}

}  // namespace soft_tissue::studies
