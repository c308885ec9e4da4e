#include "soft_tissue_sim/node/urdf_tool.h"

#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "urdf_geometry.h"
#include "urdf_linkage.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::ToolConfig;

urdf::ModelInterfaceSharedPtr readModel(const std::string& file)
{
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream)
  {
    throw Error("can't be read");
  }
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text.str());
  if (!model)
  {
    throw Error("is not a valid robot description");
  }
  return model;
}

std::string linksWithCollision(const urdf::ModelInterface& model)
{
  std::string names;
  for (const auto& [name, link] : model.links_)
  {
    if (!link->collision_array.empty())
    {
      names += (names.empty() ? "" : ", ") + name;
    }
  }
  return names.empty() ? "none has" : "those that have: " + names;
}

/** Gathers what is wrong, so that all of it is told at once. */
class Complaints
{
 public:
  template <typename Task>
  void during(const std::string& link, const Task& task)
  {
    try
    {
      task();
    }
    catch (const Error& error)
    {
      text_ += (text_.empty() ? "" : "; ") + ("link '" + link + "': ") + error.what();
    }
  }

  void raise() const
  {
    if (!text_.empty())
    {
      throw Error(text_);
    }
  }

 private:
  std::string text_;
};

/** Reads the links of one tool. */
class Reader
{
 public:
  Reader(ToolConfig& tool, const urdf::ModelInterface& model, const std::string& scratch)
      : tool_(tool),
        model_(model),
        folder_(std::filesystem::absolute(tool.urdf->file).parent_path().string()),
        scratch_{scratch}
  {}

  void read()
  {
    std::vector<std::string> links = tool_.urdf->links;
    const std::string frame = tool_.urdf->frame.empty() ? links[0] : tool_.urdf->frame;
    for (const std::string& link : links)
    {
      complaints_.during(link, [&] { check(link, true); });
    }
    complaints_.raise();
    complaints_.during(frame, [&] { check(frame, false); });
    complaints_.raise();
    links.push_back(frame);
    tool_.linkage = urdfLinkage(
        model_, links, tool_.pose_source.kind == soft_tissue::PoseSourceConfig::Kind::base);
    tool_.frame = tool_.linkage.find(frame);
    for (const std::string& link : tool_.urdf->links)
    {
      addShapes(*model_.getLink(link));
    }
    complaints_.raise();
    checkJaw();
  }

 private:
  void check(const std::string& name, bool needs_geometry) const
  {
    const urdf::LinkConstSharedPtr link = model_.getLink(name);
    if (!link)
    {
      throw Error("does not exist");
    }
    if (needs_geometry && link->collision_array.empty())
    {
      throw Error("has no collision geometry; " + linksWithCollision(model_));
    }
  }

  void addShapes(const urdf::Link& link)
  {
    const std::size_t number = tool_.linkage.find(link.name);
    for (const urdf::CollisionSharedPtr& collision : link.collision_array)
    {
      complaints_.during(link.name, [&] {
        if (!collision || !collision->geometry)
        {
          throw Error("has a collision element without geometry");
        }
        tool_.shapes.push_back({urdfShape(*collision->geometry, folder_, scratch_),
                                poseConfig(collision->origin), number});
      });
    }
    for (const urdf::VisualSharedPtr& visual : link.visual_array)
    {
      addVisual(link.name, number, visual);
    }
  }

  /** Looks that can't be had are no reason not to simulate. */
  void addVisual(const std::string& link, std::size_t number, const urdf::VisualSharedPtr& visual)
  {
    try
    {
      if (visual && visual->geometry)
      {
        tool_.visuals.push_back(urdfVisual(*visual, folder_));
        tool_.visuals.back().origin = poseConfig(visual->origin);
        tool_.visuals.back().link = number;
      }
    }
    catch (const Error& error)
    {
      tool_.remarks.push_back("urdf " + tool_.urdf->file + ": link '" + link +
                              "' is shown without a visual: " + error.what());
    }
  }

  void checkJaw() const
  {
    for (std::size_t k = 0; tool_.jaw && k < tool_.jaw->joints.size(); ++k)
    {
      const std::string& joint = tool_.jaw->joints[k].joint;
      const std::vector<soft_tissue::Coordinate>& all = tool_.linkage.coordinates();
      if (tool_.linkage.findCoordinate(joint) == all.size())
      {
        std::string names;
        for (const soft_tissue::Coordinate& one : all)
        {
          names += " " + one.name;
        }
        throw Error("jaw: there is no joint '" + joint +
                    "' that moves the links by itself; there " +
                    (names.empty() ? "is none" : "are" + names));
      }
    }
  }

  ToolConfig& tool_;
  const urdf::ModelInterface& model_;
  std::string folder_;
  Scratch scratch_;
  Complaints complaints_;
};
}  // namespace

void readUrdf(ToolConfig& tool, const std::string& scratch)
{
  try
  {
    const urdf::ModelInterfaceSharedPtr model = readModel(tool.urdf->file);
    Reader(tool, *model, scratch).read();
  }
  catch (const Error& error)
  {
    throw Error("urdf " + tool.urdf->file + ": " + error.what());
  }
  tool.urdf.reset();
}

}  // namespace soft_tissue_sim
