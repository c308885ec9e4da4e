#include <gtest/gtest.h>

#include <fstream>

#include "soft_tissue_sim/scene/scene.h"
#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
std::vector<std::string> remarksOnMesh(const std::string& elements, int count)
{
  const ScratchFolder folder;
  const std::string file = folder.path("tissue.msh");
  std::ofstream(file) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 0.01 0 0\n"
                         "3 0 0.01 0\n4 0 0 0.01\n5 0.01 0.01 0.01\n6 0.05 0 0\n$EndNodes\n"
                         "$Elements\n"
                      << count << "\n"
                      << elements << "$EndElements\n";
  std::vector<std::string> remarks = Scene(tissueScene(file)).tissues()[0].remarks;
  for (std::string& remark : remarks)
  {
    EXPECT_EQ(remark.find(file + ": "), 0u) << remark;
    remark.erase(0, file.size() + 2);
  }
  return remarks;
}

TEST(MeshRemarks, TellWhatReadingTurnedAndLeftOut)
{
  EXPECT_EQ(
      remarksOnMesh("1 4 2 1 1 1 3 2 4\n2 4 2 1 1 2 3 4 5\n3 2 2 1 1 1 2 3\n", 3),
      (std::vector<std::string>{"1 elements that are not tets left out", "1 node belongs to no tet",
                                "1 left-handed tets were turned"}));
}

TEST(MeshRemarks, AreNoneForAMeshUsedAsItIs)
{
  EXPECT_TRUE(Scene(lobeScene()).tissues()[0].remarks.empty());
}

}  // namespace
}  // namespace soft_tissue::test
