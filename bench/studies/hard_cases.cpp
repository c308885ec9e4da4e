#include "hard_cases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/geometry/box3.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue::studies
{
namespace
{
constexpr double kLength = 0.06, kSide = 0.02;  // of the bar, m
const BoxConfig kFoot{Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)};

/** Small numbers that look random, the same everywhere. */
class Noise
{
 public:
  /** In [-1, 1]. */
  double operator()()
  {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1.0;
  }
  Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
  std::uint64_t state_ = 42;
};

std::string labelled(const char* format, double value)
{
  char text[80];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

/** Builds cases, all of them from a bar along x whose end at x = 0 is fixed. */
class Catalogue
{
 public:
  explicit Catalogue(std::string folder) : folder_(std::move(folder)) {}

  std::vector<HardCase> cases;

  std::string save(const std::string& name, const TetMesh& mesh) const
  {
    const std::string file = folder_ + "/" + name + ".msh";
    saveGmsh(file, mesh);
    return file;
  }

  /** A case with the bar, or another mesh, in no gravity. */
  HardCase& add(const std::string& name, const std::string& file)
  {
    HardCase one;
    one.name = name;
    one.config.file = name;
    one.config.time_step_s = 0.01;
    one.config.gravity_m_per_s2.setZero();
    TissueConfig tissue;
    tissue.name = "body";
    tissue.mesh.file = file;
    tissue.material = {MaterialModel::neo_hookean, 5000.0, 0.4, 1000.0};
    one.config.tissues.push_back(tissue);
    cases.push_back(one);
    return cases.back();
  }

  HardCase& addBar(const std::string& name)
  {
    if (bar_.empty())
    {
      bar_ = save("bar", makeBox({6, 2, 2}, {kLength, kSide, kSide}));
    }
    HardCase& one = add(name, bar_);
    one.config.tissues[0].fixed.push_back(kFoot);
    return one;
  }

 private:
  std::string folder_, bar_;
};

TissueConfig& body(HardCase& one)
{
  return one.config.tissues[0];
}

/** Puts all nodes that aren't fixed where place(rest) says, at rest. */
template <typename Place>
void deform(Scene& scene, const Place& place)
{
  const TissueInfo& info = scene.tissues()[0];
  Points x = info.rest.nodes;
  for (Vec3& p : x)
  {
    p = place(p);
  }
  for (const Index node : info.fixed_nodes)
  {
    x[node] = info.rest.nodes[node];
  }
  scene.setMotion(0, x, Points(x.size(), Vec3::Zero()));
}

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

void addSteps(Catalogue& all)
{
  for (const double ms : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
  {
    HardCase& one = all.addBar(labelled("step of %g ms, own weight", ms));
    one.config.time_step_s = 1e-3 * ms;
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.ending = Ending::anything;
  }
}

void addMaterials(Catalogue& all)
{
  const auto bent = [](Scene& scene) {
    deform(scene, [](const Vec3& p) { return Vec3(p + Vec3(0.0, 0.0, 8.0 * p.x() * p.x())); });
  };
  for (const double modulus : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9})
  {
    HardCase& one = all.addBar(labelled("E %g Pa, let go bent", modulus));
    body(one).material.young_modulus_pa = modulus;
    one.begin = bent;
    one.ending = modulus < 5e3 ? Ending::anything : Ending::returns;  // it swings for minutes
  }
  for (const double ratio : {-0.5, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999})
  {
    HardCase& one = all.addBar(labelled("nu %g, let go bent", ratio));
    body(one).material.poisson_ratio = ratio;
    one.begin = bent;
  }
  for (const bool soft_foot : {true, false})
  {
    TetMesh mesh = makeBox({6, 2, 2}, {kLength, kSide, kSide});
    mesh.tags.clear();
    for (const Tet& tet : mesh.tets)
    {
      const double middle = 0.25 * (mesh.nodes[tet[0]].x() + mesh.nodes[tet[1]].x() +
                                    mesh.nodes[tet[2]].x() + mesh.nodes[tet[3]].x());
      mesh.tags.push_back((middle < 0.5 * kLength) == soft_foot ? 1 : 2);
    }
    HardCase& one = all.add(soft_foot ? "E 1e6 times stiffer beyond the middle"
                                      : "E 1e6 times softer beyond the middle",
                            all.save(soft_foot ? "soft_foot" : "hard_foot", mesh));
    body(one).fixed.push_back(kFoot);
    body(one).material.young_modulus_pa = 2e4;
    RegionConfig stiff;
    stiff.tag = 2;
    stiff.young_modulus_pa = 2e10;
    body(one).regions.push_back(stiff);
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.ending = Ending::anything;
    one.may_hold = soft_foot;
  }
}

/** All ways a body can be ruined, by law. */
void addRuins(Catalogue& all)
{
  struct Ruin
  {
    const char* name;
    std::function<Vec3(const Vec3&)> place;
    Ending ending;
  };
  const Vec3 middle(0.5 * kLength, 0.5 * kSide, 0.5 * kSide);
  const std::vector<Ruin> ruins = {
      {"all in a point", [=](const Vec3&) { return middle; }, Ending::settles},
      {"all in a plane", [=](const Vec3& p) { return Vec3(p.x(), p.y(), middle.z()); },
       Ending::returns},
      {"all in a line", [=](const Vec3& p) { return Vec3(p.x(), middle.y(), middle.z()); },
       Ending::returns},
      {"inside out", [=](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); }, Ending::settles},
  };
  for (const MaterialModel model :
       {MaterialModel::neo_hookean, MaterialModel::corotated, MaterialModel::exponential})
  {
    const std::string law = model == MaterialModel::neo_hookean ? "neo_hookean, "
                            : model == MaterialModel::corotated ? "corotated, "
                                                                : "exponential, ";
    const auto addRuin = [&](const std::string& name) -> HardCase& {
      HardCase& one = all.addBar(law + name);
      body(one).material.model = model;
      if (model == MaterialModel::exponential)
      {
        body(one).material.stiffening = 2.0;
      }
      return one;
    };
    for (const Ruin& ruin : ruins)
    {
      HardCase& one = addRuin(ruin.name);
      one.ending = ruin.ending;
      const auto place = ruin.place;
      one.begin = [place](Scene& scene) { deform(scene, place); };
    }
    for (const double size : {1.0, 10.0})
    {
      HardCase& one = addRuin(labelled("random places, %g times its length", size));
      // Far apart, the law that stiffens stays in a knot.
      const bool knot = model == MaterialModel::exponential && size > 1.0;
      one.ending = knot ? Ending::anything : Ending::settles;
      one.may_hold = true;
      one.begin = [=](Scene& scene) {
        Noise noise;
        deform(scene, [&](const Vec3&) { return Vec3(middle + size * kLength * noise.vector()); });
      };
    }
  }
}

void addSlivers(Catalogue& all)
{
  for (const double height : {1e-4, 1e-6})
  {
    // One of two nodes in a cell's middle is moved onto the plane of a face, nearly.
    TetMesh mesh = makeBox({4, 2, 2}, {kLength, kSide, kSide});
    Vec3& inner = mesh.nodes[22];
    inner.z() += (0.5 - height) * kSide;
    HardCase& one = all.add(labelled("slivers, %g of their size high", height),
                            all.save(labelled("sliver%g", height), mesh));
    body(one).fixed.push_back(kFoot);
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.ending = Ending::anything;
  }
}

void addTools(Catalogue& all)
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

void addMotions(Catalogue& all)
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

/** Real meshes, brought to 10 cm, hang by a tenth of their height. */
void addRealMeshes(Catalogue& all, const std::string& hard)
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
}  // namespace

std::vector<HardCase> hardCases(const std::string& folder, const std::string& hard)
{
  Catalogue all(folder);
  addSteps(all);
  addMaterials(all);
  addRuins(all);
  addSlivers(all);
  addTools(all);
  addMotions(all);
  if (!hard.empty())
  {
    addRealMeshes(all, hard);
  }
  return std::move(all.cases);
}
}  // namespace soft_tissue::studies
