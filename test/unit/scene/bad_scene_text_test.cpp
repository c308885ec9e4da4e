#include <gtest/gtest.h>

#include <random>
#include <string>

#include "bad_scene.h"

namespace soft_tissue
{
namespace
{
/** Files that are wrong as a whole: not there, not text, not YAML, not a scene. */
class BadSceneTextTest : public testing::Test
{
 protected:
  std::string complaint(const std::string& text) { return complaintAbout(folder_, text); }

  std::string complaintOfPath(const std::string& path)
  {
    try
    {
      loadSceneConfig(path, findPackage);
    }
    catch (const Error& error)
    {
      return replaced(error.what(), folder_.path(), "DIR");
    }
    return "no complaint";
  }

  SceneFolder folder_;
};

TEST_F(BadSceneTextTest, MissingFileAndFolder)
{
  EXPECT_EQ(complaintOfPath(folder_.path() + "/gone.yaml"), "DIR/gone.yaml: no such file");
  EXPECT_EQ(complaintOfPath(folder_.path() + "/folder"),
            "DIR/folder: is a folder or device, must be a file");
}

TEST_F(BadSceneTextTest, FileOfMoreThan64Megabytes)
{
  std::filesystem::resize_file(folder_.write("huge.yaml", ""), 67108865);
  EXPECT_EQ(complaintOfPath(folder_.path() + "/huge.yaml"),
            "DIR/huge.yaml: has 67108865 bytes, must be at most 67108864");
}

TEST_F(BadSceneTextTest, EmptyFile)
{
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n", "~\n"})
  {
    EXPECT_EQ(complaint(text), "DIR/scene.yaml: is empty") << text;
  }
}

TEST_F(BadSceneTextTest, NotAMap)
{
  const std::string known =
      "must be a map of keys: time_step_s, gravity_m_per_s2, materials, solver, tissues, "
      "membranes, tools, obstacles, contacts, outputs";
  EXPECT_EQ(complaint("- a\n- b\n"), "DIR/scene.yaml: " + known);
  EXPECT_EQ(complaint("just words"), "DIR/scene.yaml: " + known);
}

TEST_F(BadSceneTextTest, NoTissue)
{
  EXPECT_EQ(complaint("time_step_s: 0.01\n"),
            "DIR/scene.yaml: tissues: missing, must have a tissue, or membranes a membrane");
  EXPECT_EQ(complaint("tissues: []\nmembranes: []\n"),
            "DIR/scene.yaml: tissues: missing, must have a tissue, or membranes a membrane");
  EXPECT_EQ(complaint("tissues:\n"), "DIR/scene.yaml: tissues = nothing, must be a list");
  EXPECT_EQ(complaint("tissues: [liver]\n"),
            "DIR/scene.yaml: tissues[0] = liver, must be a map of keys: name, mesh, pose, "
            "velocity_m_per_s, material, element, regions, fixed, keyframes, field");
}

TEST_F(BadSceneTextTest, SyntaxErrorsHaveLineAndColumn)
{
  EXPECT_EQ(complaint("tissues: [\n"),
            "DIR/scene.yaml: line 2, column 1: end of sequence flow not "
            "found");
  EXPECT_EQ(complaint("a: 1\n b: 2\n"), "DIR/scene.yaml: line 2, column 3: illegal map value");
  EXPECT_EQ(complaint("tissues: *liver\n"),
            "DIR/scene.yaml: line 1, column 10: the referenced anchor is not defined");
}

TEST_F(BadSceneTextTest, MoreThanOneDocument)
{
  EXPECT_EQ(complaint(std::string(kGood) + "---\ntissues: []\n"),
            "DIR/scene.yaml: has 2 YAML documents, must have one; remove the '---' lines");
}

TEST_F(BadSceneTextTest, BytesThatAreNotUtf8)
{
  const std::string not_utf8 = ", which is not UTF-8; save the file as UTF-8";
  // In turn: a lone continuation, Latin-1, an overlong '/', a surrogate, above U+10FFFF, cut short.
  EXPECT_EQ(complaint("ab\x80"), "DIR/scene.yaml: byte 2 is 0x80" + not_utf8);
  EXPECT_EQ(complaint("name: l\xe9ver"), "DIR/scene.yaml: byte 7 is 0xe9" + not_utf8);
  EXPECT_EQ(complaint("a\xc0\xaf"), "DIR/scene.yaml: byte 1 is 0xc0" + not_utf8);
  EXPECT_EQ(complaint("\xed\xa0\x80"), "DIR/scene.yaml: byte 0 is 0xed" + not_utf8);
  EXPECT_EQ(complaint("\xf4\x90\x80\x80"), "DIR/scene.yaml: byte 0 is 0xf4" + not_utf8);
  EXPECT_EQ(complaint("abc\xe2\x82"), "DIR/scene.yaml: byte 3 is 0xe2" + not_utf8);
  EXPECT_EQ(complaint("\xff\xfe"
                      "a"),
            "DIR/scene.yaml: byte 0 is 0xff" + not_utf8);
}

TEST_F(BadSceneTextTest, ControlCharactersThatWouldEndTheFileUnseen)
{
  const std::string control = ", a control character; YAML allows only tab and line ends";
  EXPECT_EQ(complaint(std::string("a: 1\n\0b: 2\n", 11)),
            "DIR/scene.yaml: byte 5 is 0x00" + control);
  EXPECT_EQ(complaint("a: 1\n\x04"
                      "b: 2\n"),
            "DIR/scene.yaml: byte 5 is 0x04" + control);
}

TEST_F(BadSceneTextTest, CorrectUtf8IsLetPass)
{
  const std::string comment = "# \xc3\xa9 \xe2\x82\xac \xf0\x9f\xab\x80\r\n";
  EXPECT_EQ(complaint("\xef\xbb\xbf" + comment + kGood), "no complaint");
}

TEST_F(BadSceneTextTest, ListsNestedTenThousandDeepAreRefusedNotFollowed)
{
  const std::string message = complaint("tissues: " + std::string(10000, '['));
  EXPECT_EQ(message.rfind("DIR/scene.yaml: line 1, column ", 0), 0U) << message;
}

TEST_F(BadSceneTextTest, LongValuesAreCutBetweenCharacters)
{
  std::string name;
  for (int i = 0; i < 100; ++i)
  {
    name += "\xc3\xa9";
  }
  EXPECT_EQ(complaint(replaced(kGood, "name: liver", "name: a" + name)),
            "DIR/scene.yaml: tissues[0].name = a" + name.substr(0, 58) +
                "..., must be a name: a letter, then letters, digits or _");
}

TEST_F(BadSceneTextTest, AnchorsMayRefill)
{
  EXPECT_EQ(complaint(replaced(replaced(kGood,
                                        "mesh: {file: mesh.msh, length_unit: m}\n    "
                                        "material: {young_modulus_pa: 3000",
                                        "mesh: &mesh {file: mesh.msh, length_unit: m}\n    "
                                        "material: {young_modulus_pa: 3000"),
                               "mesh: {file: mesh.msh, length_unit: m}\n    material: "
                               "{young_modulus_pa: 9000",
                               "mesh: *mesh\n    material: {young_modulus_pa: 9000")),
            "no complaint");
}

TEST_F(BadSceneTextTest, MutilatedFilesAreReadOrRefusedButNothingElse)
{
  const std::string spare = "[]{}:,-#&*!|>'\"%@ \n\t0aZ.~\xff\x01";
  std::minstd_rand random(1);
  const auto below = [&](std::size_t size) { return random() % size; };
  int refused = 0;
  for (int round = 0; round < 2000; ++round)
  {
    std::string text = kGood;
    for (std::size_t change = 0; change <= below(3); ++change)
    {
      const std::size_t at = below(text.size());
      switch (below(3))
      {
        case 0:
          text[at] = spare[below(spare.size())];
          break;
        case 1:
          text.erase(at, 1 + below(20));
          break;
        default:
          text.insert(at, text.substr(below(text.size()), 1 + below(20)));
      }
    }
    const std::string message = complaint(text);
    const bool names_file = message.rfind("DIR/scene.yaml: ", 0) == 0;
    EXPECT_TRUE(names_file || message == "no complaint") << message;
    refused += names_file ? 1 : 0;
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace soft_tissue
