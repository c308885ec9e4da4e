#include "hard_cases.h"

#include <cstdint>
#include <cstdio>
#include <utility>

#include "hard_catalogue.h"

namespace soft_tissue::studies
{
namespace
{
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

void addSteps(HardCatalogue& all)
{
  for (const double ms : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
  {
    HardCase& one = all.addBar(labelled("step of %g ms, own weight", ms));
    one.config.time_step_s = 1e-3 * ms;
    one.config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    one.ending = Ending::anything;
  }
}

void addMaterials(HardCatalogue& all)
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
  for (const double ratio : {0.45, 0.4999})
  {
    for (const bool quadratic : {false, true})
    {
      HardCase& one = all.addBar(labelled(
          quadratic ? "quadratic, nu %g, let go bent" : "nodal pressure, nu %g, let go bent",
          ratio));
      body(one).element = quadratic ? ElementKind::tet10 : ElementKind::tet4_anp;
      body(one).material.poisson_ratio = ratio;
      one.begin = bent;
    }
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
    one.ending = Ending::settles;
  }
}

/** All ways a body can be ruined, by law and element. */
void addRuins(HardCatalogue& all)
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
  struct Kind
  {
    const char* name;
    MaterialModel model;
    ElementKind element;
  };
  for (const Kind& kind : {Kind{"neo_hookean, ", MaterialModel::neo_hookean, ElementKind::tet4},
                           {"corotated, ", MaterialModel::corotated, ElementKind::tet4},
                           {"exponential, ", MaterialModel::exponential, ElementKind::tet4},
                           {"nodal pressure, ", MaterialModel::neo_hookean, ElementKind::tet4_anp},
                           {"quadratic, ", MaterialModel::neo_hookean, ElementKind::tet10},
                           {"mass_spring, ", MaterialModel::mass_spring, ElementKind::tet4}})
  {
    const MaterialModel model = kind.model;
    const auto addRuin = [&](const std::string& name) -> HardCase& {
      HardCase& one = all.addBar(kind.name + name);
      body(one).material.model = model;
      body(one).element = kind.element;
      if (model == MaterialModel::exponential)
      {
        body(one).material.stiffening = 2.0;
      }
      return one;
    };
    for (const Ruin& ruin : ruins)
    {
      HardCase& one = addRuin(ruin.name);
      const bool folds = model == MaterialModel::mass_spring || kind.element == ElementKind::tet10;
      one.ending = folds ? Ending::settles : ruin.ending;
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

void addSlivers(HardCatalogue& all)
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

}  // namespace

std::vector<HardCase> hardCases(const std::string& folder, const std::string& hard)
{
  HardCatalogue all(folder);
  addSteps(all);
  addMaterials(all);
  addRuins(all);
  addSlivers(all);
  addDrivenCases(all);
  if (!hard.empty())
  {
    addRealMeshes(all, hard);
  }
  return std::move(all.cases);
}
}  // namespace soft_tissue::studies
