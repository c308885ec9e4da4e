#include "contact_cost.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <vector>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue::studies
{
namespace
{
constexpr double kRadius = 0.05;

/** How two balls meet. */
struct Meeting
{
  const char* name;
  double overlap;  ///< of their radius; below zero they are apart
  enum class Contact
  {
    none,
    points,
    segments,
  } contact;
};

TissueConfig ball(const char* name, const std::string& file, double height)
{
  TissueConfig tissue;
  tissue.name = name;
  tissue.mesh.file = file;
  tissue.pose.position_m = Vec3(0.0, 0.0, height);
  // Not the same way round as the other: no node or edge meets its like.
  tissue.pose.rotation_rpy_rad = Vec3(height, 2.0 * height, 3.0 * height);
  tissue.material = {MaterialModel::neo_hookean, 5000.0, 0.45, 1000.0};
  return tissue;
}

/** Contact is so soft that the balls stay overlapped while they are looked at. */
SceneConfig sceneOf(const Meeting& meeting, const std::string& file)
{
  SceneConfig config;
  config.file = "contact cost";
  config.time_step_s = 0.005;
  config.gravity_m_per_s2.setZero();
  config.tissues = {ball("one", file, 0.0), ball("other", file, (2.0 - meeting.overlap) * kRadius)};
  if (meeting.contact != Meeting::Contact::none)
  {
    ContactConfig contact;
    contact.tissue = "one";
    contact.other = "other";
    contact.response =
        meeting.contact == Meeting::Contact::points ? Response::point : Response::segment;
    contact.stiffness_pa_per_m = 2e4;
    config.contacts.push_back(contact);
  }
  return config;
}

/** Times of a scene's steps, ms. */
struct Times
{
  std::vector<double> field, detect, respond, total;
  double found = 0.0, deepest_m = 0.0, newton = 0.0;

  void add(const StepReport& report)
  {
    field.push_back(report.ms.field);
    detect.push_back(report.ms.detect);
    respond.push_back(report.ms.respond);
    total.push_back(report.ms.total);
    found = report.contacts;
    deepest_m = std::max(deepest_m, report.max_penetration_m);
    newton += report.newton_iterations;
  }
};

double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}
}  // namespace

void studyContactCost(const std::string& folder, bool quick)
{
  using Contact = Meeting::Contact;
  const std::vector<Meeting> meetings = {{"overlapping", 0.1, Contact::segments},
                                         {"overlapping", 0.1, Contact::points},
                                         {"apart", -0.5, Contact::segments},
                                         {"apart", -0.5, Contact::points},
                                         {"apart", -0.5, Contact::none}};
  const std::string path = folder + "/contact_cost.csv";
  std::ofstream stream(path);
  stream << "case,tets,contact,samples,deepest_mm,newton,field_ms,detect_ms,respond_ms,total_ms,"
            "contact_share\n";
  const char* const kNames[] = {"none", "point", "segment"};
  for (const std::size_t tets :
       quick ? std::vector<std::size_t>{1000} : std::vector<std::size_t>{5000, 20000, 50000})
  {
    const std::string file = folder + "/ball.msh";
    saveGmsh(file, makeBall(kRadius, tets));
    std::vector<Scene> scenes;
    std::vector<Times> times(meetings.size());
    for (const Meeting& meeting : meetings)
    {
      scenes.emplace_back(sceneOf(meeting, file));
    }
    for (int step = -2; step < (quick ? 3 : 31); ++step)  // the first ones prepare
    {
      for (std::size_t k = 0; k < scenes.size(); ++k)
      {
        const StepReport& report = scenes[k].step();
        if (step >= 0)
        {
          times[k].add(report);
        }
      }
    }
    for (std::size_t k = 0; k < scenes.size(); ++k)
    {
      const Times& t = times[k];
      const double contact = median(t.field) + median(t.detect) + median(t.respond);
      char line[300];
      std::snprintf(line, sizeof(line), "%s,%zu,%s,%g,%.4g,%.3g,%.4g,%.4g,%.4g,%.4g,%.4g\n",
                    meetings[k].name, scenes[k].tissues()[0].rest.tets.size(),
                    kNames[static_cast<int>(meetings[k].contact)], t.found, 1e3 * t.deepest_m,
                    t.newton / static_cast<double>(t.total.size()), median(t.field),
                    median(t.detect), median(t.respond), median(t.total),
                    contact / median(t.total));
      stream << line << std::flush;
      std::printf("contact cost: %s", line);
    }
  }
  if (!stream)
  {
    throw Error(path + ": can't be written");
  }
}

}  // namespace soft_tissue::studies
