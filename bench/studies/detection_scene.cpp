#include "detection_scene.h"

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/collision/segment_filter.h"
#include "soft_tissue_sim/geometry/clip.h"
#include "soft_tissue_sim/geometry/tet_overlap.h"

namespace soft_tissue::studies
{
namespace
{
Box3 boxOf(const ElementSet& set, Index element, const Points& x)
{
  Box3 box;
  for (int k = 0; k < set.nodes_each; ++k)
  {
    box.extend(x[set.nodes[element * set.nodes_each + k]]);
  }
  return box;
}

std::array<Vec3, 4> cornersOf(const DetectionBody& body, Index tet)
{
  const Tet& t = body.mesh.tets[tet];
  return {body.x[t[0]], body.x[t[1]], body.x[t[2]], body.x[t[3]]};
}

bool cuts(const DetectionBody& body, Index edge, const TetCoordinates& tet)
{
  const Edge& nodes = body.surface.edges[edge];
  const auto piece = clipSegment(body.x[nodes[0]], body.x[nodes[1]], tet);
  return piece && piece->lambda1 < piece->lambda2;
}
}  // namespace

DetectionBody::DetectionBody(TetMesh body)
    : mesh(std::move(body)),
      surface(extractBoundary(static_cast<Index>(mesh.nodes.size()), mesh.tets)),
      x(mesh.nodes)
{}

ElementSet DetectionBody::edges() const
{
  return {surface.edges.front().data(), 2, static_cast<Index>(surface.edges.size())};
}

ElementSet DetectionBody::tets() const
{
  return {mesh.tets.front().data(), 4, static_cast<Index>(mesh.tets.size())};
}

void DetectionScene::move(int turn)
{
  const double t = 0.7 * turn;
  const auto place = [&](DetectionBody& body, const Vec3& shift, double phase) {
    for (std::size_t i = 0; i < body.x.size(); ++i)
    {
      const Vec3& p = body.mesh.nodes[i];
      const Vec3 bend(std::sin(2.0 * p.y() + t + phase), std::sin(2.0 * p.z() + 1.3 * t),
                      std::sin(2.0 * p.x() + 0.8 * t - phase));
      body.x[i] = p + shift + wobble * bend + 1e-3 * std::sin(t) * Vec3(0.3, 1.0, 0.5);
    }
  };
  place(a, Vec3::Zero(), 0.0);
  place(b, shift, 1.0);
}

std::size_t countPieces(const DetectionBody& first, const DetectionBody& second,
                        std::vector<ElementPair>& pairs, std::vector<ClippedPair>& pieces)
{
  dropParted(first.edges(), first.x.data(), second.tets(), second.x.data(), 0.0, pairs);
  clipPairs(first.edges(), first.x.data(), second.tets(), second.x.data(), pairs, pieces);
  return pieces.size();
}

std::size_t countPiecesOneByOne(const DetectionBody& first, const DetectionBody& second,
                                const std::vector<ElementPair>& pairs)
{
  return std::count_if(pairs.begin(), pairs.end(), [&](const ElementPair& pair) {
    const std::array<Vec3, 4> p = cornersOf(second, pair.second);
    const auto coordinates = tetCoordinates(p[0], p[1], p[2], p[3]);
    return coordinates && cuts(first, pair.first, *coordinates);
  });
}

std::size_t countTetsOneByOne(const DetectionBody& first, const DetectionBody& second,
                              const std::vector<ElementPair>& pairs)
{
  return std::count_if(pairs.begin(), pairs.end(), [&](const ElementPair& pair) {
    return tetsOverlap(cornersOf(first, pair.first), cornersOf(second, pair.second));
  });
}

std::vector<ElementPair> everyPair(const ElementSet& first, const ElementSet& second,
                                   const Points& x_first, const Points& x_second, bool one_body)
{
  std::vector<Box3> boxes;
  Box3 all;
  for (Index i = 0; i < first.count; ++i)
  {
    boxes.push_back(boxOf(first, i, x_first));
    all.extend(boxes.back());
  }
  const auto shareNode = [&](Index i, Index j) {
    const Index* const a = first.nodes + i * first.nodes_each;
    const Index* const b = second.nodes + j * second.nodes_each;
    return std::find_first_of(a, a + first.nodes_each, b, b + second.nodes_each) !=
           a + first.nodes_each;
  };
  std::vector<ElementPair> pairs;
  for (Index j = 0; j < second.count; ++j)
  {
    const Box3 box = boxOf(second, j, x_second);
    for (Index i = 0; box.overlaps(all) && i < first.count; ++i)
    {
      if (boxes[i].overlaps(box) && !(one_body && shareNode(i, j)))
      {
        pairs.push_back({i, j});
      }
    }
  }
  return pairs;
}

}  // namespace soft_tissue::studies
