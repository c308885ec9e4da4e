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

/** The one link a urdf shape takes, named in either of two ways. */
struct UrdfKeys
{
  std::string file;
  std::string link;
};

void oneLink(UrdfKeys& keys, const std::vector<std::string>& links)
{
  keys.link = links.size() == 1 ? links.front() : "";
}

const Section<UrdfKeys>& urdfSection()
{
  static const Section<UrdfKeys> section =
      Section<UrdfKeys>("urdf", "The collision geometry of a link of a robot description.")
          .required("file", &UrdfKeys::file, file(),
                    "URDF file. Relative paths start at the scene file.")
          .alternative("link", &UrdfKeys::link, text(),
                       "The link; the tool frame is the link's frame.")
          .alternative("links", oneLink, listOf(text(), 1),
                       "The same as a list; more than one link is not available yet.")
          .finally([](const Item& item, UrdfKeys& keys) {
            if (keys.link.empty())
            {
              item.at("links").rejectValue("more than one link is " + std::string(kNotAvailable));
            }
          });
  return section;
}

template <class Shape>
void setGeometry(ToolShapeConfig& shape, const Shape& geometry)
{
  shape.solid.geometry = geometry;
}

void setUrdf(ToolShapeConfig& shape, const UrdfKeys& keys)
{
  shape.urdf = UrdfShapeConfig{keys.file, keys.link};
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
          .alternative("urdf", setUrdf, mapOf(urdfSection()), "A link of a URDF file.")
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
