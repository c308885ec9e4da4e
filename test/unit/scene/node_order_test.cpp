#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
/** The same body with its nodes in another order: node i becomes numbers[i]. */
TetMesh withNumbers(const TetMesh& mesh, const std::vector<Index>& numbers)
{
  TetMesh other = mesh;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    other.nodes[numbers[i]] = mesh.nodes[i];
  }
  for (Tet& tet : other.tets)
  {
    std::for_each(tet.begin(), tet.end(), [&](Index& node) { node = numbers[node]; });
  }
  return other;
}

class NodeOrder : public testing::TestWithParam<ElementKind>
{
 protected:
  NodeOrder() : mesh_(makeBox({6, 3, 3}, {0.06, 0.03, 0.03})), numbers_(mesh_.nodes.size())
  {
    std::iota(numbers_.begin(), numbers_.end(), 0);
    std::shuffle(numbers_.begin(), numbers_.end(), std::mt19937(7));
  }

  /** A beam held at one end. */
  Scene scene(const TetMesh& mesh, const std::string& name)
  {
    SceneConfig config = tissueScene(saved(folder_, name, mesh));
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    config.solver.tolerance = 1e-10;
    config.solver.max_iterations = 50;
    config.tissues[0].element = GetParam();
    config.tissues[0].fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
    return Scene(config);
  }

  ScratchFolder folder_;
  TetMesh mesh_;
  std::vector<Index> numbers_;
};
}  // namespace

TEST_P(NodeOrder, IsThatOfTheFileWhateverItIs)
{
  Scene plain = scene(mesh_, "plain.msh"), mixed = scene(withNumbers(mesh_, numbers_), "mixed.msh");
  const TissueInfo& info = mixed.tissues()[0];
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
  {
    EXPECT_EQ(plain.tissues()[0].rest.nodes[i], mesh_.nodes[i]);
    EXPECT_EQ(info.rest.nodes[numbers_[i]], mesh_.nodes[i]);
  }
  EXPECT_TRUE(std::is_sorted(info.fixed_nodes.begin(), info.fixed_nodes.end()));
  EXPECT_EQ(info.fixed_nodes.size(), plain.tissues()[0].fixed_nodes.size());
  for (const Index node : info.fixed_nodes)
  {
    EXPECT_EQ(info.rest.nodes[node].x(), 0.0);
  }
  for (const Triangle& t : info.surface.triangles)  // seen from outside, of a box about its middle
  {
    const Vec3 &a = info.rest.nodes[t[0]], &b = info.rest.nodes[t[1]], &c = info.rest.nodes[t[2]];
    EXPECT_GT((b - a).cross(c - a).dot(a - Vec3(0.03, 0.015, 0.015)), 0.0);
  }
  for (int step = 0; step < 5; ++step)
  {
    plain.step();
    mixed.step();
  }
  Snapshot one, other;
  plain.fillSnapshot(one);
  mixed.fillSnapshot(other);
  ASSERT_EQ(other.tissues[0].positions.size(), info.rest.nodes.size());
  double most = 0.0;
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
  {
    const Vec3& p = other.tissues[0].positions[numbers_[i]];
    const Vec3& v = other.tissues[0].velocities[numbers_[i]];
    EXPECT_LT((p - one.tissues[0].positions[i]).norm(), 1e-8);
    EXPECT_LT((v - one.tissues[0].velocities[i]).norm(), 1e-6);
    most = std::max(most, (p - mesh_.nodes[i]).norm());
  }
  EXPECT_GT(most, 1e-3);
}

TEST_P(NodeOrder, IsWhatMotionIsSetIn)
{
  Scene mixed = scene(withNumbers(mesh_, numbers_), "mixed.msh");
  Points x = mixed.tissues()[0].rest.nodes, v = x;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    x[i] += 1e-3 * static_cast<double>(i) * Vec3::UnitY();
    v[i] = static_cast<double>(i) * Vec3::UnitZ();
  }
  mixed.setMotion(0, x, v);
  Snapshot state;
  mixed.fillSnapshot(state);
  EXPECT_EQ(state.tissues[0].positions, x);
  EXPECT_EQ(state.tissues[0].velocities, v);
}

INSTANTIATE_TEST_SUITE_P(Elements, NodeOrder,
                         testing::Values(ElementKind::tet4, ElementKind::tet10));

}  // namespace soft_tissue::test
