#include "cad_surface.h"

#include <cmath>

#include "soft_tissue_sim/base/error.h"

#ifdef SOFT_TISSUE_HAVE_OPENCASCADE
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Geom_Surface.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <fstream>
#include <numeric>

#include "soft_tissue_sim/mesh/check.h"
#endif

namespace soft_tissue
{
#ifdef SOFT_TISSUE_HAVE_OPENCASCADE
namespace
{
constexpr double kMetre = 1000.0;  // what is in here is in mm, as OpenCASCADE's tolerances are
/** Edges no farther apart than this share of the chord are one; and corners, of this one. */
constexpr double kSewing = 0.1, kSameCorner = 1e-4;
constexpr double kAngle = 0.5;  // rad between triangles side by side
constexpr int kTries = 8;
constexpr int kSamples = 6;  // along a triangle's edge
/** Share of the chord that samples may be off: between them a little more is. */
constexpr double kSampled = 0.9;

Vec3 vector(const gp_Pnt& p)
{
  return {p.X(), p.Y(), p.Z()};
}

std::string formatOf(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
  {
    throw Error(path + ": can't be opened");
  }
  std::string line;
  std::getline(stream, line);
  if (line.find("ISO-10303-21") != std::string::npos)
  {
    return "STEP";
  }
  if (line.size() >= 73 && line[72] == 'S')
  {
    return "IGES";
  }
  throw Error(path +
              ": is neither a STEP file, which begins with ISO-10303-21, nor an IGES file, " +
              "whose first line has an S in column 73");
}

template <typename Reader>
TopoDS_Shape transfer(const std::string& path, const std::string& format)
{
  Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
  {
    throw Error(path + ": can't be read as a " + format + " file");
  }
  const int roots = reader.NbRootsForTransfer(), read = reader.TransferRoots();
  if (read < roots)
  {
    throw Error(path + ": only " + std::to_string(read) + " of " + std::to_string(roots) +
                " shapes in it could be read");
  }
  return reader.NbShapes() > 0 ? reader.OneShape() : TopoDS_Shape();
}

TopoDS_Shape readShape(const std::string& path, const std::string& format)
{
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  return format == "STEP" ? transfer<STEPControl_Reader>(path, format)
                          : transfer<IGESControl_Reader>(path, format);
}

std::vector<TopoDS_Face> facesOf(const TopoDS_Shape& shape)
{
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
  {
    faces.push_back(TopoDS::Face(at.Current()));
  }
  return faces;
}

/** Joins faces that belong to no solid. @return whether there were any */
bool sewLooseFaces(TopoDS_Shape& shape, double chord)
{
  TopExp_Explorer loose(shape, TopAbs_FACE, TopAbs_SOLID);
  if (!loose.More())
  {
    return false;
  }
  BRepBuilderAPI_Sewing sewing(kSewing * chord);
  sewing.Add(shape);
  sewing.Perform();
  shape = sewing.SewedShape();
  return true;
}

/** Farthest of triangles' sample points from their faces, looked for until one is too far. */
class Deviation
{
 public:
  explicit Deviation(double most) : most_(most) {}

  void look(const BRepAdaptor_Surface& face, const std::array<Vec3, 3>& corners,
            const std::array<gp_Pnt2d, 3>& parameters)
  {
    for (int i = 0; i <= kSamples; ++i)
    {
      for (int j = 0; i + j <= kSamples; ++j)
      {
        const Vec3 w = Vec3(i, j, kSamples - i - j) / kSamples;
        const Vec3 flat = w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2];
        double u = 0.0, v = 0.0;
        for (int k = 0; k < 3; ++k)
        {
          u += w[k] * parameters[k].X();
          v += w[k] * parameters[k].Y();
        }
        if (tooFar())
        {
          return;
        }
        // The face's point of the same parameters is near, perhaps not the nearest.
        double distance = (vector(face.Value(u, v)) - flat).norm();
        if (distance > most_)
        {
          distance = std::min(distance, toNearest(face, flat));
        }
        largest_ = std::max(largest_, distance);
        ++samples_;
      }
    }
  }

  bool tooFar() const { return largest_ > most_; }
  double largest() const { return largest_; }
  std::size_t samples() const { return samples_; }

 private:
  static double toNearest(const BRepAdaptor_Surface& face, const Vec3& p)
  {
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face.Face());
    const GeomAPI_ProjectPointOnSurf projection(gp_Pnt(p.x(), p.y(), p.z()), surface);
    return projection.NbPoints() > 0 ? projection.LowerDistance()
                                     : std::numeric_limits<double>::infinity();
  }

  double most_;
  double largest_ = 0.0;
  std::size_t samples_ = 0;
};

/** Appends a face's triangles, each with corners of its own. @return false if it has none */
bool addFace(const TopoDS_Face& face, TriMesh& mesh, Deviation& deviation)
{
  TopLoc_Location place;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, place);
  if (triangles.IsNull() || !triangles->HasUVNodes())
  {
    return false;
  }
  const BRepAdaptor_Surface surface(face);
  const Index offset = static_cast<Index>(mesh.nodes.size());
  for (int i = 1; i <= triangles->NbNodes(); ++i)
  {
    mesh.nodes.push_back(vector(triangles->Node(i).Transformed(place.Transformation())));
  }
  for (int i = 1; i <= triangles->NbTriangles(); ++i)
  {
    std::array<int, 3> at;
    triangles->Triangle(i).Get(at[0], at[1], at[2]);
    if (face.Orientation() == TopAbs_REVERSED)
    {
      std::swap(at[1], at[2]);
    }
    std::array<Vec3, 3> corners;
    std::array<gp_Pnt2d, 3> parameters;
    Triangle triangle;
    for (int k = 0; k < 3; ++k)
    {
      triangle[k] = offset + at[k] - 1;
      corners[k] = mesh.nodes[triangle[k]];
      parameters[k] = triangles->UVNode(at[k]);
    }
    mesh.triangles.push_back(triangle);
    deviation.look(surface, corners, parameters);
  }
  return true;
}

/** Makes corners at one place one, and drops triangles that lose one by it: those at a pole. */
void weld(TriMesh& mesh, double apart)
{
  std::vector<Index> order(mesh.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return mesh.nodes[a].x() < mesh.nodes[b].x(); });
  std::vector<Index> first(mesh.nodes.size(), -1);
  Points nodes;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const Vec3& p = mesh.nodes[order[i]];
    for (std::size_t j = i; j-- > 0 && p.x() - mesh.nodes[order[j]].x() <= apart;)
    {
      if ((mesh.nodes[order[j]] - p).norm() <= apart)
      {
        first[order[i]] = first[order[j]];
        break;
      }
    }
    if (first[order[i]] < 0)
    {
      first[order[i]] = static_cast<Index>(nodes.size());
      nodes.push_back(p);
    }
  }
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles)
  {
    const Triangle welded = {first[t[0]], first[t[1]], first[t[2]]};
    if (welded[0] != welded[1] && welded[1] != welded[2] && welded[2] != welded[0])
    {
      triangles.push_back(welded);
    }
  }
  mesh = {std::move(nodes), std::move(triangles)};
}

/** Triangles within the chord, mm. */
TriMesh tessellate(const std::string& path, const TopoDS_Shape& shape, double chord,
                   CadSurface& report)
{
  double asked = kSampled * chord, found = 0.0;
  for (int k = 0; k < kTries; ++k)
  {
    BRepTools::Clean(shape);
    BRepMesh_IncrementalMesh(shape, asked, false, kAngle, false);
    TriMesh mesh;
    Deviation deviation(kSampled * chord);
    const std::vector<TopoDS_Face> faces = facesOf(shape);
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
      if (!addFace(faces[i], mesh, deviation))
      {
        throw Error(path + ": OpenCASCADE finds no triangles for face " + std::to_string(i + 1) +
                    " of " + std::to_string(faces.size()));
      }
    }
    weld(mesh, kSameCorner * chord);
    found = deviation.largest();
    report.deviation_m = found / kMetre;
    report.samples = deviation.samples();
    if (!deviation.tooFar())
    {
      return mesh;
    }
    asked *= 0.5;
  }
  throw Error(path + ": triangles stay " + std::to_string(found / kMetre) +
              " m away from their faces, more than the " + std::to_string(chord / kMetre) +
              " m asked for");
}

CadSurface load(const std::string& path, double chord_m)
{
  CadSurface report;
  report.format = formatOf(path);
  TopoDS_Shape shape = readShape(path, report.format);
  if (shape.IsNull() || facesOf(shape).empty())
  {
    throw Error(path + ": the " + report.format + " file holds no faces");
  }
  report.sewn = sewLooseFaces(shape, chord_m * kMetre);
  report.faces = facesOf(shape).size();
  report.mesh = tessellate(path, shape, chord_m * kMetre, report);
  for (Vec3& p : report.mesh.nodes)
  {
    p /= kMetre;
  }
  const SurfaceCheck check = checkSurface(report.mesh);
  report.turned = check.topology.open_edges == 0 && check.volume_m3 < 0.0;
  if (report.turned)
  {
    for (Triangle& t : report.mesh.triangles)
    {
      std::swap(t[1], t[2]);
    }
  }
  return report;
}
}  // namespace

CadSurface loadCadSurface(const std::string& path, double chord_m)
{
  if (!(chord_m > 0.0) || !std::isfinite(chord_m))
  {
    throw Error("chord = " + std::to_string(chord_m) + " m, must be > 0");
  }
  try
  {
    return load(path, chord_m);
  }
  catch (const Standard_Failure& failure)
  {
    throw Error(path + ": OpenCASCADE fails: " + failure.GetMessageString());
  }
}
#else
CadSurface loadCadSurface(const std::string& path, double)
{
  throw Error(path + ": this mesh_tool was built without OpenCASCADE, which reads STEP and IGES; " +
              "install its development files (Debian: libocct-data-exchange-dev) and build again");
}
#endif

}  // namespace soft_tissue
