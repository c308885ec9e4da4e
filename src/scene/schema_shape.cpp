#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
const Section<SphereShape>& sphereSection()
{
  static const Section<SphereShape> section =
      Section<SphereShape>("sphere", "A ball about the shape's origin.")
          .required("radius_m", &SphereShape::radius_m, shapeLength(), "Radius.");
  return section;
}

const Section<CapsuleShape>& capsuleSection()
{
  static const Section<CapsuleShape> section =
      Section<CapsuleShape>("capsule",
                            "A segment along z, centred at the shape's origin, swept by a ball.")
          .required("radius_m", &CapsuleShape::radius_m, shapeLength(), "Radius of the ball.")
          .required("length_m", &CapsuleShape::length_m, shapeLength(),
                    "Length of the segment: the capsule's without its two caps.");
  return section;
}

const Section<BoxShape>& boxSection()
{
  static const Section<BoxShape> section =
      Section<BoxShape>("box", "A box centred at the shape's origin, along its axes.")
          .required("size_m", &BoxShape::size_m, edgeLengths(), "Full edge lengths.");
  return section;
}

const Section<MeshShape>& meshShapeSection()
{
  static const Section<MeshShape> section =
      Section<MeshShape>("tool mesh", "A closed triangle mesh.")
          .required(
              "file", [](MeshShape & s) -> auto& { return s.mesh.file; }, file(),
              "STL, OBJ, PLY or VTK. Relative paths start at the scene file.")
          .required(
              "length_unit", [](MeshShape & s) -> auto& { return s.mesh.metres_per_unit; },
              lengthUnit(), "Unit of the coordinates in the file.")
          .optional("scale", &MeshShape::scale, factors(), "Factors along x, y and z.");
  return section;
}

/** Text; empty stands for the first of the links. */
Kind<std::string> frameLink()
{
  Kind<std::string> kind = text();
  kind.show = [](const std::string& link) {
    return link.empty() ? std::string("the first link") : link;
  };
  return kind;
}

void setLink(UrdfShapeConfig& urdf, const std::string& link)
{
  urdf.links = {link};
}

void checkLinks(const Item& item, UrdfShapeConfig& urdf)
{
  for (std::size_t i = 0; i < urdf.links.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (urdf.links[i] == urdf.links[j])
      {
        const Item links = item.at("links");
        links.at(i).rejectValue("is " + links.at(j).path() + " too, must be new");
      }
    }
  }
}

const Section<UrdfShapeConfig>& urdfSection()
{
  static const Section<UrdfShapeConfig> section =
      Section<UrdfShapeConfig>("urdf", "The collision geometry of links of a robot description.")
          .required("file", &UrdfShapeConfig::file, file(),
                    "URDF file. Relative paths start at the scene file.")
          .alternative("link", setLink, text(), "The link.")
          .alternative("links", &UrdfShapeConfig::links, listOf(text(), 1),
                       "Several, which the URDF's joints move against each other.")
          .optional("frame", &UrdfShapeConfig::frame, frameLink(),
                    "Any link of the URDF: its frame is the tool frame.")
          .finally(checkLinks);
  return section;
}

template <class Shape>
void setGeometry(ToolShapeConfig& shape, const Shape& geometry)
{
  shape.solid.geometry = geometry;
}

void setUrdf(ToolShapeConfig& shape, const UrdfShapeConfig& urdf)
{
  shape.urdf = urdf;
}

}  // namespace

const Section<ToolShapeConfig>& toolShapeSection()
{
  static const Section<ToolShapeConfig> section =
      Section<ToolShapeConfig>("shape", "One rigid solid of a tool.")
          .alternative("sphere", setGeometry<SphereShape>, mapOf(sphereSection()), "A ball.")
          .alternative("capsule", setGeometry<CapsuleShape>, mapOf(capsuleSection()),
                       "A rod with round ends.")
          .alternative("box", setGeometry<BoxShape>, mapOf(boxSection()), "A box.")
          .alternative("mesh", setGeometry<MeshShape>, mapOf(meshShapeSection()),
                       "A triangle mesh file.")
          .alternative("urdf", setUrdf, mapOf(urdfSection()), "Links of a URDF file.")
          .optional(
              "origin", [](ToolShapeConfig & s) -> auto& { return s.solid.origin; },
              mapOf(poseSection()),
              "Where the shape's frame stands in the tool frame; not with urdf, whose links "
              "have origins of their own.")
          .finally([](const Item& item, ToolShapeConfig& shape) {
            if (shape.urdf && item.has("origin"))
            {
              item.rejectKey("origin", "must not stand beside urdf, which has its own");
            }
          });
  return section;
}

}  // namespace soft_tissue
