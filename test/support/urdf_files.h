#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "soft_tissue_sim/node/urdf_tool.h"

namespace soft_tissue_sim
{
/** Writes URDFs and reads tools from them. */
class UrdfTool : public testing::Test
{
 protected:
  std::string writeUrdf(const std::string& links) const
  {
    const std::string file = folder_.path() + "/robot.urdf";
    std::ofstream(file) << "<robot name=\"r\">" << links << "</robot>";
    return file;
  }

  std::string writeLink(const std::string& inner) const
  {
    return writeUrdf("<link name=\"tip\">" + inner + "</link>");
  }

  soft_tissue::ToolConfig tool(const std::string& file, const std::vector<std::string>& links,
                               const std::string& frame = "") const
  {
    soft_tissue::ToolConfig tool;
    tool.name = "tool";
    tool.urdf = soft_tissue::UrdfShapeConfig{file, links, frame};
    readUrdf(tool, folder_.path());
    return tool;
  }

  std::vector<soft_tissue::ShapeConfig> shapes(const std::string& file,
                                               const std::string& link = "tip") const
  {
    return tool(file, {link}).shapes;
  }

  /** What the conversion complains of; empty if of nothing. */
  std::string complaint(const std::string& file, const std::string& link = "tip",
                        const std::string& frame = "") const
  {
    try
    {
      tool(file, {link}, frame);
      return "";
    }
    catch (const soft_tissue::Error& error)
    {
      return error.what();
    }
  }

  ScratchFolder folder_;
};

inline std::string collision(const std::string& geometry, const std::string& origin = "")
{
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

inline bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

}  // namespace soft_tissue_sim
