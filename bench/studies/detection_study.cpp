#include "detection_study.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numeric>
#include <random>

#include "bullet_tets.h"
#include "detection_scene.h"
#include "fcl_surfaces.h"
#include "field_table.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/collision/overlapping_tets.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue::studies
{
namespace
{
/** A way to find what touches. */
struct Contestant
{
  std::string name;
  std::function<std::size_t()> find;    ///< how many candidates there are
  std::function<std::size_t()> narrow;  ///< how many of them touch
  std::function<std::size_t()> truth;   ///< how many do, by brute force; none: not known
  std::vector<double> find_ms, ms;
  std::size_t found = 0, touching = 0;
};

struct NamedMethod
{
  const char* name;
  PairMethod method;
};
constexpr NamedMethod kMethods[] = {
    {"tree", PairMethod::tree}, {"hash", PairMethod::hash}, {"sweep", PairMethod::sweep}};

/** The ways of a scene, each with what it keeps from call to call. */
class Contest
{
 public:
  explicit Contest(DetectionScene& scene) : scene_(scene)
  {
    for (const NamedMethod& method : kMethods)
    {
      addEdges(method, !scene.one_body);
    }
    if (!scene.one_body)
    {
      for (const NamedMethod& method : kMethods)
      {
        addEdges(method, false);
      }
      for (const NamedMethod& method : kMethods)
      {
        addTets(method);
      }
      addOthers();
    }
  }

  std::vector<Contestant>& run(int turns)
  {
    for (int turn = -2; turn < turns; ++turn)  // the first ones prepare
    {
      scene_.move(turn);
      for (Contestant* const contestant : inAnyOrder())
      {
        Contestant& one = *contestant;
        Timer timer;
        one.found = one.find();
        const double find_ms = 1e3 * timer.seconds();
        one.touching = one.narrow();
        if (turn >= 0)
        {
          one.find_ms.push_back(find_ms);
          one.ms.push_back(1e3 * timer.seconds());
        }
      }
    }
    return contestants_;
  }

 private:
  using Pairs = std::vector<ElementPair>;

  /** The first body's edges in the second one's tets, or its own; and the other way, if both. */
  void addEdges(const NamedMethod& method, bool both)
  {
    const std::shared_ptr<PairFinder> there =
        makePairFinder(method.method, scene_.a.edges(), scene_.second().tets(), scene_.one_body);
    const std::shared_ptr<PairFinder> back =
        makePairFinder(method.method, scene_.b.edges(), scene_.a.tets(), false);
    const auto pairs = std::make_shared<std::array<Pairs, 2>>();
    const auto pieces = std::make_shared<std::vector<ClippedPair>>();
    const DetectionBody &a = scene_.a, &b = scene_.second();
    const bool one_body = scene_.one_body;
    add({std::string(method.name) + (both ? ", edges in tets, both ways" : ", edges in tets"),
         [=, &a, &b] {
           there->find(a.x.data(), b.x.data(), 0.0, (*pairs)[0]);
           if (both)
           {
             back->find(b.x.data(), a.x.data(), 0.0, (*pairs)[1]);
           }
           return (*pairs)[0].size() + (*pairs)[1].size();
         },
         [=, &a, &b] {
           return countPieces(a, b, (*pairs)[0], *pieces) +
                  (both ? countPieces(b, a, (*pairs)[1], *pieces) : 0);
         },
         [=, &a, &b] {
           return countPiecesOneByOne(a, b, everyPair(a.edges(), b.tets(), a.x, b.x, one_body)) +
                  (both ? countPiecesOneByOne(b, a, everyPair(b.edges(), a.tets(), b.x, a.x, false))
                        : 0);
         },
         {},
         {}});
  }

  void addTets(const NamedMethod& method)
  {
    const std::shared_ptr<PairFinder> finder =
        makePairFinder(method.method, scene_.a.tets(), scene_.b.tets(), false);
    const auto find = [finder](const DetectionBody& a, const DetectionBody& b, Pairs& pairs) {
      finder->find(a.x.data(), b.x.data(), 0.0, pairs);
    };
    addTetsFoundBy(std::string(method.name) + ", tets in tets", find);
  }

  template <typename Find>
  void addTetsFoundBy(const std::string& name, const Find& find)
  {
    const auto pairs = std::make_shared<Pairs>(), overlapping = std::make_shared<Pairs>();
    const DetectionBody &a = scene_.a, &b = scene_.b;
    add({name,
         [=, &a, &b] {
           find(a, b, *pairs);
           return pairs->size();
         },
         [=, &a, &b] {
           findOverlappingTets(a.tets(), a.x.data(), b.tets(), b.x.data(), *pairs, *overlapping);
           return overlapping->size();
         },
         [=, &a, &b] {
           return countTetsOneByOne(a, b, everyPair(a.tets(), b.tets(), a.x, b.x, false));
         },
         {},
         {}});
  }

  void addOthers()
  {
    const DetectionBody &a = scene_.a, &b = scene_.b;
    for (const bool inside : {true, false})
    {
      const auto surfaces =
          std::make_shared<FclSurfaces>(a.surface.triangles, a.x, b.surface.triangles, b.x);
      const auto count = std::make_shared<std::size_t>(0);
      if (haveFcl())
      {
        add({inside ? "FCL, surface triangles" : "FCL, by collide()",
             [=, &a, &b] { return *count = surfaces->collide(a.x, b.x, inside); },
             [=] { return *count; },
             nullptr,
             {},
             {}});
      }
    }
    if (haveBullet())
    {
      const auto tets = std::make_shared<BulletTets>(a.mesh.tets, a.x, b.mesh.tets, b.x);
      addTetsFoundBy("Bullet, tets in tets",
                     [tets](const DetectionBody& first, const DetectionBody& second, Pairs& pairs) {
                       tets->find(first.x, second.x, pairs);
                     });
    }
  }

  /** What a way finds in caches is up to those before it. */
  std::vector<Contestant*> inAnyOrder()
  {
    std::vector<Contestant*> order;
    for (Contestant& one : contestants_)
    {
      order.push_back(&one);
    }
    std::shuffle(order.begin(), order.end(), random_);
    return order;
  }

  void add(Contestant contestant) { contestants_.push_back(std::move(contestant)); }

  DetectionScene& scene_;
  std::vector<Contestant> contestants_;
  std::mt19937 random_;
};

class DetectionTable
{
 public:
  explicit DetectionTable(const std::string& folder)
      : path_(folder + "/detection.csv"), stream_(path_)
  {
    stream_ << "scene,tets,edges,method,found,touching,missed,find_ms,ms,mean_ms,worst_ms\n";
    check();
  }

  void run(DetectionScene scene, int turns)
  {
    scene.move(-3);
    Contest contest(scene);
    std::printf("%s, %zu tets, %zu edges\n", scene.name.c_str(), scene.a.mesh.tets.size(),
                scene.a.surface.edges.size());
    for (const Contestant& one : contest.run(turns))
    {
      const std::string missed =
          one.truth
              ? std::to_string(static_cast<long>(one.truth()) - static_cast<long>(one.touching))
              : "";
      const double worst = *std::max_element(one.ms.begin(), one.ms.end());
      const double mean = std::accumulate(one.ms.begin(), one.ms.end(), 0.0) / one.ms.size();
      char line[300];
      std::snprintf(line, sizeof(line), "%s,%zu,%zu,\"%s\",%zu,%zu,%s,%.4g,%.4g,%.4g,%.4g\n",
                    scene.name.c_str(), scene.a.mesh.tets.size(), scene.a.surface.edges.size(),
                    one.name.c_str(), one.found, one.touching, missed.c_str(), median(one.find_ms),
                    median(one.ms), mean, worst);
      stream_ << line << std::flush;
      check();
      std::printf(
          "  %-32s %8zu found %7zu touch, missed %1s %9.4f ms, with the exact test %9.4f ms, "
          "mean %9.4f, worst %9.4f\n",
          one.name.c_str(), one.found, one.touching, missed.c_str(), median(one.find_ms),
          median(one.ms), mean, worst);
      std::fflush(stdout);
    }
  }

 private:
  void check() const
  {
    if (!stream_)
    {
      throw Error(path_ + ": can't be written");
    }
  }

  std::string path_;
  std::ofstream stream_;
};

/** Two balls of radius 1 m; `overlap` of it in common, apart if below zero. */
DetectionScene balls(const std::string& name, std::size_t tets, double overlap)
{
  const TetMesh ball = makeBall(1.0, tets);
  return {name, DetectionBody(ball), DetectionBody(ball), Vec3(2.0 - overlap, 0.013, 0.02)};
}
}  // namespace

void studyDetection(const std::string& folder, bool quick)
{
  DetectionTable table(folder);
  const int turns = quick ? 1 : 31;
  for (const std::size_t tets :
       quick ? std::vector<std::size_t>{2000} : std::vector<std::size_t>{5000, 20000, 50000})
  {
    table.run(balls("overlapping by 10 %", tets, 0.1), turns);
    table.run(balls("apart", tets, -0.5), turns);
  }
  const std::size_t most = quick ? 2000 : 50000;
  DetectionScene bent = balls("overlapping by 10 % and bent", most, 0.1);
  bent.wobble = 0.05;
  table.run(bent, turns);
  DetectionScene moving = balls("overlapping by 10 % and moving", most, 0.1);
  moving.wobble = 0.006;  // the node that moves most goes 0.008 m; edges have 0.08 m
  table.run(moving, turns);
  for (const double overlap : quick ? std::vector<double>{} : std::vector<double>{0.05, 0.2, 0.4})
  {
    table.run(balls("overlapping by " + std::to_string(int(100.0 * overlap)) + " %", most, overlap),
              turns);
  }
  for (const std::size_t tets :
       quick ? std::vector<std::size_t>{1000} : std::vector<std::size_t>{14000, 56000})
  {
    const DetectionBody tube(makeTube(0.4, 0.5, 2.0, tets));
    table.run({"tube with itself", tube, tube, Vec3::Zero(), true}, turns);
  }
}

}  // namespace soft_tissue::studies
