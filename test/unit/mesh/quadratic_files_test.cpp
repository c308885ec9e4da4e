#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"
#include "support/mesh_files.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
/** The vertices between which a format puts an element's fifth to tenth node. */
using EdgeOrder = std::array<Edge, 6>;
constexpr EdgeOrder kGmshOrder = {{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}}};
constexpr EdgeOrder kVtkOrder = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/** A mesh of quadratic tets as a file has it: nodes in no order a reader could count on. */
struct QuadraticFile
{
  Points nodes;
  std::vector<std::vector<Index>> elements;
  std::vector<int> tags;

  QuadraticFile(const TetMesh& mesh, const EdgeOrder& order) : tags(mesh.tags)
  {
    const QuadraticTetMesh quadratic = withEdgeNodes(mesh);
    const auto count = static_cast<Index>(quadratic.nodes.size());
    const auto place = [&](Index node) { return (node * 5 + 3) % count; };
    nodes.resize(count);
    for (Index i = 0; i < count; ++i)
    {
      nodes[place(i)] = quadratic.nodes[i];
    }
    for (const QuadraticTet& element : quadratic.elements)
    {
      elements.emplace_back();
      for (int k = 0; k < 4; ++k)
      {
        elements.back().push_back(place(element[k]));
      }
      for (const Edge& ends : order)
      {
        for (int edge = 0; edge < 6; ++edge)
        {
          if (std::minmax(ends[0], ends[1]) ==
              std::minmax<Index>(kTetEdges[edge][0], kTetEdges[edge][1]))
          {
            elements.back().push_back(place(element[4 + edge]));
          }
        }
      }
    }
  }

  std::string gmsh() const
  {
    test::Content out;
    out.text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n").value(nodes.size()).text("\n");
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      out.value(i + 1).point<double>(nodes[i]).text("\n");
    }
    out.text("$EndNodes\n$Elements\n").value(elements.size() + 1).text("\n");
    out.text("1 9 2 0 1");  // a quadratic triangle
    for (const int k : {0, 1, 2, 4, 5, 6})
    {
      out.text(" ").value(elements[0][k] + 1);
    }
    for (std::size_t e = 0; e < elements.size(); ++e)
    {
      out.text("\n").value(e + 2).value(11).value(2).value(tags[e]).value(9);
      for (const Index node : elements[e])
      {
        out.value(node + 1);
      }
    }
    return out.text("\n$EndElements\n").str();
  }

  std::string vtk() const
  {
    test::Content out;
    out.text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS ");
    out.value(nodes.size()).text("float\n");
    for (const Vec3& p : nodes)
    {
      out.point<float>(p).text("\n");
    }
    out.text("CELLS ").value(elements.size() + 1).value(11 * elements.size() + 7).text("\n6");
    for (const int k : {0, 1, 2, 4, 5, 6})
    {
      out.text(" ").value(elements[0][k]);
    }
    for (const std::vector<Index>& element : elements)
    {
      out.text("\n10 ");
      for (const Index node : element)
      {
        out.value(node);
      }
    }
    out.text("\nCELL_TYPES ").value(elements.size() + 1).text("\n22\n");
    for (std::size_t e = 0; e < elements.size(); ++e)
    {
      out.text("24\n");
    }
    return out.str();
  }
};

/** Two tets none of whose edges are alike. */
TetMesh sample()
{
  TetMesh mesh = test::twoTets();
  mesh.nodes[1].x() = 1.5;
  mesh.nodes[3] = Vec3(0.3, 0.2, 0.7);
  return mesh;
}

void expectSample(const std::string& path, double tolerance, bool with_tags)
{
  const TetMesh mesh = sample();
  const LoadedTetMesh loaded = loadTetMesh(path, 0.5);
  ASSERT_EQ(loaded.mesh.nodes.size(), mesh.nodes.size()) << "vertices alone";
  ASSERT_EQ(loaded.mesh.tets.size(), mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Vec3& found = loaded.mesh.nodes[loaded.mesh.tets[t][k]];
      EXPECT_LT((found - 0.5 * mesh.nodes[mesh.tets[t][k]]).norm(), tolerance);
    }
  }
  if (with_tags)
  {
    EXPECT_EQ(loaded.mesh.tags, mesh.tags);
  }
  EXPECT_EQ(loaded.report.ignored_elements, 1U);
  ASSERT_EQ(loaded.report.warnings.size(), 1U);
  EXPECT_EQ(loaded.report.warnings[0],
            "2 quadratic tets were read by their vertices; element tet10 puts nodes in the middle "
            "of edges again");
}

void expectRefusal(const std::string& path, const std::string& place, const std::string& reason)
{
  try
  {
    loadTetMesh(path, 1.0);
    FAIL() << "read";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(path + place), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(QuadraticFiles, AreReadByTheirVertices)
{
  test::ScratchFolder folder;
  expectSample(folder.write("a.msh", QuadraticFile(sample(), kGmshOrder).gmsh()), 1e-15, true);
  expectSample(folder.write("a.vtk", QuadraticFile(sample(), kVtkOrder).vtk()), 1e-6, false);
}

// Taken for the other's order, two nodes are far from the middle of their edges.
TEST(QuadraticFiles, OfOneFormatAreNotReadInTheOrderOfAnother)
{
  test::ScratchFolder folder;
  const std::string curved =
      "quadratic tet 1 of the file is curved: the node between its vertices "
      "2 and 4 is ";
  expectRefusal(folder.write("a.msh", QuadraticFile(sample(), kVtkOrder).gmsh()), ":24: ", curved);
  expectRefusal(folder.write("a.vtk", QuadraticFile(sample(), kGmshOrder).vtk()), ":", curved);
}

TEST(QuadraticFiles, AreRefusedWhereTheyAreCurved)
{
  test::ScratchFolder folder;
  QuadraticFile file(sample(), kGmshOrder);
  const Index vertex = file.elements[1][3], other = file.elements[1][0];
  const double length = (file.nodes[vertex] - file.nodes[other]).norm();
  Vec3& middle = file.nodes[file.elements[1][7]];
  const Vec3 straight = middle;
  middle += Vec3(0.0, 0.0, 0.9e-3 * length);
  EXPECT_EQ(loadTetMesh(folder.write("a.msh", file.gmsh()), 1.0).mesh.tets.size(), 2U);
  middle = straight + Vec3(0.0, 0.0, 0.02 * length);
  expectRefusal(folder.write("a.msh", file.gmsh()), ":25: ",
                "quadratic tet 2 of the file is curved: the node between its vertices 1 and 4 is "
                "0.02 edge lengths off the middle, must be in [0, 0.001]");
  middle = straight;
  middle.y() = std::nan("");
  expectRefusal(folder.write("a.msh", file.gmsh()), ":", "must be");
}

TEST(QuadraticFiles, AreRefusedWhereALinearTetHangsOnTheMiddleOfAnEdge)
{
  test::ScratchFolder folder;
  std::string text = QuadraticFile(sample(), kGmshOrder).gmsh();
  const QuadraticFile file(sample(), kGmshOrder);
  test::Content tet;
  tet.text("1 4 2 0 1 ").value(file.elements[0][4] + 1).value(file.elements[0][1] + 1);
  tet.value(file.elements[0][2] + 1).value(file.elements[0][3] + 1).text("\n");
  const std::size_t place = text.find("1 9 2 0 1");
  text.replace(place, text.find('\n', place) + 1 - place, tet.str());
  expectRefusal(folder.write("a.msh", text), ": ",
                "tet 1 has for a vertex what is in the middle of a quadratic tet's edge");
}

}  // namespace
}  // namespace soft_tissue
