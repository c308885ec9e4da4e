#include <Eigen/Geometry>
#include <algorithm>

#include "hard_catalogue.h"
#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue::studies
{
namespace
{
void addBox(HardCase& one, const std::string& name, const Vec3& size, const Vec3& at)
{
  ToolConfig tool;
  tool.name = name;
  tool.shapes.push_back({BoxShape{size}, {}});
  tool.initial_pose.position_m = at;
  one.config.tools.push_back(tool);
  ContactConfig contact;
  contact.tissue = "body";
  contact.other = name;
  one.config.contacts.push_back(contact);
}

void addBall(HardCase& one, const std::string& name, double radius, const Vec3& at)
{
  addBox(one, name, Vec3::Ones(), at);
  one.config.tools.back().shapes[0].geometry = SphereShape{radius};
}

Pose at(const Vec3& position)
{
  Pose pose = Pose::Identity();
  pose.translation() = position;
  return pose;
}

void addTools(HardCatalogue& all)
{
  const Vec3 middle(0.5 * kLength, 0.5 * kSide, 0.5 * kSide);
  {
    HardCase& one = all.addBar("ball put 10 cm on, into the body, and back");
    const Vec3 away = middle + Vec3(0.0, 0.0, 0.1);
    addBall(one, "ball", 0.006, away);
    one.before = [=](Scene& scene, int step) {
      scene.setToolTarget(0, at(step / 50 % 2 == 1 && step < 300 ? middle : away));
    };
  }
  {
    HardCase& one = all.addBar("squeezed flat between two plates");
    addBox(one, "below", Vec3(0.2, 0.2, 0.02), Vec3(0.05, 0.01, -0.0101));
    addBox(one, "above", Vec3(0.2, 0.2, 0.02), Vec3(0.05, 0.01, kSide + 0.0101));
    body(one).fixed.clear();
    one.before = [=](Scene& scene, int step) {
      const double down = step < 300 ? std::min(0.9 * kSide, 1e-4 * step) : 0.0;
      scene.setToolTarget(0, at(Vec3(0.05, 0.01, -0.0101)));
      scene.setToolTarget(1, at(Vec3(0.05, 0.01, kSide + 0.0101 - down)));
    };
    one.may_hold = true;
  }
  {
    HardCase& one = all.addBar("two tools pinch through");
    addBall(one, "left", 0.005, middle - Vec3(0.0, 0.02, 0.0));
    addBall(one, "right", 0.005, middle + Vec3(0.0, 0.02, 0.0));
    one.before = [=](Scene& scene, int step) {
      const double in = step < 250 ? std::min(0.02, 2e-4 * step) : 0.0;
      scene.setToolTarget(0, at(middle - Vec3(0.0, 0.02 - in, 0.0)));
      scene.setToolTarget(1, at(middle + Vec3(0.0, 0.02 - in, 0.0)));
    };
    one.may_hold = true;
  }
  {
    HardCase& one = all.addBar("dropped from 1 m onto a table");
    body(one).fixed.clear();
    body(one).pose.position_m = Vec3(0.0, 0.0, 1.0);
    addBox(one, "table", Vec3(2.0, 2.0, 0.05), Vec3(0.0, 0.0, -0.025));
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.config.contacts.back().friction = 0.3;
    one.ending = Ending::settles;
  }
}

void addMotions(HardCatalogue& all)
{
  {
    HardCase& one = all.addBar("pulled to five times its length, and let back");
    NodeMotionConfig end;
    end.nodes = {Vec3(kLength - 1e-6, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)};
    PoseConfig there;
    there.position_m = Vec3(4.0 * kLength, 0.0, 0.0);
    end.motion = {{0.0, {}}, {1.0, there}, {2.0, there}, {3.0, {}}};
    body(one).keyframes.push_back(end);
  }
  {
    HardCase& one = all.addBar("spun at 100 rad/s");
    body(one).fixed.clear();
    body(one).material.young_modulus_pa = 1e6;
    one.config.time_step_s = 0.001;
    one.begin = [](Scene& scene) {
      const Points& x = scene.tissues()[0].rest.nodes;
      Points v;
      for (const Vec3& p : x)
      {
        v.push_back(Vec3(0.0, 0.0, 100.0).cross(p - Vec3(0.5 * kLength, 0.01, 0.01)));
      }
      scene.setMotion(0, x, v);
    };
    one.ending = Ending::anything;
  }
  {
    HardCase& one = all.addBar("a hundred times its weight");
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -981.0);
    one.ending = Ending::anything;
  }
  {
    HardCase& one = all.addBar("one free node");
    body(one).fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, kSide - 1e-6)},
                       {Vec3(-1, -1, -1), Vec3(1, kSide - 1e-6, 1)},
                       {Vec3(-1, -1, -1), Vec3(kLength - 1e-6, 1, 1)}};
    one.begin = [](Scene& scene) { deform(scene, [](const Vec3&) { return Vec3(1, 1, 1); }); };
  }
  {
    HardCase& one = all.addBar("every node fixed");
    body(one).fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  }
  {
    const TetMesh tet = {{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}, {{0, 1, 2, 3}}, {}};
    HardCase& one = all.add("a single tet, turned inside out", all.save("one_tet", tet));
    one.begin = [](Scene& scene) { deform(scene, [](const Vec3& p) { return Vec3(-p); }); };
  }
  {
    TetMesh two = makeBox({2, 2, 2}, {kSide, kSide, kSide});
    const Index count = static_cast<Index>(two.nodes.size());
    const std::size_t tets = two.tets.size();
    for (Index i = 0; i < count; ++i)
    {
      two.nodes.push_back(two.nodes[i] + Vec3(3.0 * kSide, 0.0, 0.0));
    }
    for (std::size_t t = 0; t < tets; ++t)
    {
      Tet tet = two.tets[t];
      for (Index& node : tet)
      {
        node += count;
      }
      two.tets.push_back(tet);
    }
    two.tags.clear();
    HardCase& one = all.add("two parts, one of them falling", all.save("parts", two));
    body(one).fixed.push_back(kFoot);
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.ending = Ending::anything;
  }
}

}  // namespace

void addDrivenCases(HardCatalogue& all)
{
  addTools(all);
  addMotions(all);
}

/** Real meshes, brought to 10 cm, hang by a tenth of their height. */
void addRealMeshes(HardCatalogue& all, const std::string& hard)
{
  for (const char* name : {"wayne_quad.1.node", "muscle.1.node", "organic_shape.msh",
                           "HumanHeartHull.node", "c_extruded_refined.msh", "Bunny.vtk"})
  {
    Box3 box;
    for (const Vec3& p : loadTetMesh(hard + "/" + name, 1.0).mesh.nodes)
    {
      box.extend(p);
    }
    HardCase& one = all.add(name, hard + "/" + name);
    const double unit = 0.1 / (box.max - box.min).maxCoeff();
    body(one).mesh.metres_per_unit = unit;
    const double height = unit * (box.max.z() - box.min.z());
    body(one).fixed.push_back(
        {Vec3::Constant(-1e3), Vec3(1e3, 1e3, unit * box.max.z() - 0.9 * height)});
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, 9.81);
    one.ending = Ending::anything;
  }
}
}  // namespace soft_tissue::studies
