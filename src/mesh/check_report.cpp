#include <cstdio>

#include "soft_tissue_sim/mesh/check.h"

namespace soft_tissue
{
namespace
{
/** Lines of "name: value", with a mark on those that tell of trouble. */
class Report
{
 public:
  void fact(const std::string& name, const std::string& value) { line("  ", name, value); }
  void fact(const std::string& name, std::size_t count) { fact(name, std::to_string(count)); }

  /** A count that should be zero. */
  void trouble(const std::string& name, std::size_t count)
  {
    line(count == 0 ? "  " : "! ", name, std::to_string(count));
  }

  std::string text() const { return text_; }

 private:
  void line(const char* mark, const std::string& name, const std::string& value)
  {
    constexpr std::size_t kColumn = 24;
    text_ += mark + name + ":" +
             std::string(name.size() < kColumn ? kColumn - name.size() : 1, ' ') + value + "\n";
  }

  std::string text_;
};

std::string formatted(const char* format, double a, double b = 0.0, double c = 0.0)
{
  char buffer[120];
  std::snprintf(buffer, sizeof(buffer), format, a, b, c);
  return buffer;
}

void addTopology(const SurfaceTopology& topology, Report& report)
{
  report.trouble("open edges", topology.open_edges);
  report.trouble("flipped edges", topology.flipped_edges);
  report.trouble("non-manifold edges", topology.non_manifold_edges);
  report.trouble("non-manifold vertices", topology.non_manifold_vertices);
}
}  // namespace

std::string toText(const MeshCheck& check)
{
  Report report;
  report.fact("nodes", check.nodes);
  report.fact("tets", check.tets);
  report.fact("size", formatted("%.6g x %.6g x %.6g m", check.size_m.x(), check.size_m.y(),
                                check.size_m.z()));
  report.fact("volume", formatted("%.6g m^3", check.volume_m3));
  report.trouble("inverted tets", check.inverted);
  report.trouble("degenerate tets", check.degenerate);
  report.trouble("slivers (q < 0.1)", check.slivers);
  report.fact("smallest quality q", formatted("%.3g", check.min_quality));
  report.fact("dihedral angles",
              formatted("%.1f to %.1f degrees", check.min_dihedral_deg, check.max_dihedral_deg));
  report.trouble("duplicate nodes", check.duplicate_nodes);
  report.trouble("nodes in no tet", check.orphan_nodes);
  report.trouble("duplicate tets", check.duplicate_tets);
  report.trouble("faces of 3 or more tets", check.overshared_faces);
  report.fact("parts", check.parts);
  report.fact("boundary triangles", check.boundary_triangles);
  report.fact("boundary shells", check.boundary.parts);
  addTopology(check.boundary, report);
  for (const auto& [tag, count] : check.tags)
  {
    report.fact("tets with tag " + std::to_string(tag), count);
  }
  return report.text();
}

std::string toText(const SurfaceCheck& check)
{
  Report report;
  report.fact("nodes", check.nodes);
  report.fact("triangles", check.triangles);
  report.fact("size", formatted("%.6g x %.6g x %.6g m", check.size_m.x(), check.size_m.y(),
                                check.size_m.z()));
  report.fact("area", formatted("%.6g m^2", check.area_m2));
  report.fact("signed volume", formatted("%.6g m^3", check.volume_m3) +
                                   (check.volume_m3 < 0.0 ? " (inside out)" : ""));
  report.trouble("zero-area triangles", check.zero_area);
  report.trouble("duplicate nodes", check.duplicate_nodes);
  report.trouble("nodes in no triangle", check.orphan_nodes);
  report.trouble("duplicate triangles", check.duplicate_triangles);
  addTopology(check.topology, report);
  report.fact("parts", check.topology.parts);
  report.fact("bounds a volume", check.watertight() ? "yes" : "no");
  return report.text();
}

}  // namespace soft_tissue
