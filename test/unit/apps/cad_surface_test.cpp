#include "apps/cad/cad_surface.h"

#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Shape.hxx>
#include <cmath>
#include <functional>
#include <iostream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "support/mesh_files.h"

namespace soft_tissue
{
namespace
{
/** Distance of a point to a true surface, m. */
using Distance = std::function<double(const Vec3&)>;

class CadFiles : public testing::Test
{
 protected:
  void SetUp() override
  {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  }

  /** Writes a shape given in mm. */
  std::string step(const TopoDS_Shape& shape)
  {
    const std::string path = folder_.path("shape.step");
    STEPControl_Writer writer;
    EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
    EXPECT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
    return path;
  }

  std::string iges(const TopoDS_Shape& shape)
  {
    IGESControl_Controller::Init();
    const std::string path = folder_.path("shape.igs");
    IGESControl_Writer writer("MM", 0);
    EXPECT_TRUE(writer.AddShape(shape));
    writer.ComputeModel();
    EXPECT_TRUE(writer.Write(path.c_str()));
    return path;
  }

  std::string failure(const std::string& path, double chord = 1e-4)
  {
    try
    {
      loadCadSurface(path, chord);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  test::ScratchFolder folder_;
};

/** Largest distance of points all over the triangles to the surface they stand for. */
double largestDistance(const TriMesh& mesh, const Distance& distance)
{
  constexpr int kAlong = 9;
  double largest = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    for (int i = 0; i <= kAlong; ++i)
    {
      for (int j = 0; i + j <= kAlong; ++j)
      {
        const Vec3 p =
            (i * mesh.nodes[t[0]] + j * mesh.nodes[t[1]] + (kAlong - i - j) * mesh.nodes[t[2]]) /
            kAlong;
        largest = std::max(largest, std::abs(distance(p)));
      }
    }
  }
  return largest;
}

void expectClosedWithin(const std::string& path, double chord, double volume, double area,
                        const Distance& distance)
{
  const CadSurface cad = loadCadSurface(path, chord);
  const SurfaceCheck check = checkSurface(cad.mesh);
  const double found = largestDistance(cad.mesh, distance);
  std::cout << cad.format << ": " << check.triangles << " triangles, farthest " << found
            << " m, reported " << cad.deviation_m << " m, asked " << chord << " m\n";
  EXPECT_TRUE(check.watertight()) << path;
  EXPECT_LE(found, chord);
  EXPECT_LE(cad.deviation_m, chord);
  EXPECT_GE(cad.deviation_m, 0.5 * found) << "the report tells of what there is";
  EXPECT_NEAR(check.volume_m3, volume, area * chord);
  EXPECT_LT(check.volume_m3, volume) << "outward, inside a convex surface";
}

TEST_F(CadFiles, NurbsSpheresKeepTheChordAndAreClosed)
{
  const double radius = 0.05;
  BRepBuilderAPI_NurbsConvert nurbs(BRepPrimAPI_MakeSphere(1000.0 * radius).Shape());
  for (const double chord : {1e-3, 2e-4, 5e-5})
  {
    for (const std::string& path : {step(nurbs.Shape()), iges(nurbs.Shape())})
    {
      expectClosedWithin(path, chord, 4.0 / 3.0 * M_PI * std::pow(radius, 3),
                         4.0 * M_PI * radius * radius,
                         [=](const Vec3& p) { return p.norm() - radius; });
    }
  }
}

TEST_F(CadFiles, ToriAndCylindersAreReadAsWell)
{
  const double ring = 0.04, tube = 0.01, chord = 1e-4;
  const Distance to_torus = [=](const Vec3& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - ring, p.z()) - tube;
  };
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(1000.0 * ring, 1000.0 * tube).Shape();
  for (const std::string& path : {step(torus), iges(torus)})
  {
    const CadSurface cad = loadCadSurface(path, chord);
    EXPECT_TRUE(checkSurface(cad.mesh).watertight()) << path;
    EXPECT_LE(largestDistance(cad.mesh, to_torus), chord);
  }
  const double radius = 0.01, height = 0.03;
  expectClosedWithin(step(BRepPrimAPI_MakeCylinder(1000.0 * radius, 1000.0 * height).Shape()),
                     chord, M_PI * radius * radius * height,
                     2.0 * M_PI * radius * (radius + height), [=](const Vec3& p) {
                       const double out = std::hypot(p.x(), p.y()) - radius;
                       const double up = std::max(-p.z(), p.z() - height);
                       return std::max(out, up);
                     });
}

/** A patch over 60 x 60 mm that waves by 10 mm, as a NURBS with weights. */
Handle(Geom_BSplineSurface) wavyPatch()
{
  constexpr int kPoints = 7, kDegree = 3;
  TColgp_Array2OfPnt points(1, kPoints, 1, kPoints);
  TColStd_Array2OfReal weights(1, kPoints, 1, kPoints);
  for (int i = 1; i <= kPoints; ++i)
  {
    for (int j = 1; j <= kPoints; ++j)
    {
      points(i, j) = gp_Pnt(10.0 * (i - 1), 10.0 * (j - 1), (i + j) % 2 == 0 ? 10.0 : -10.0);
      weights(i, j) = i == 4 && j == 4 ? 3.0 : 1.0;
    }
  }
  TColStd_Array1OfReal knots(1, kPoints - kDegree + 1);
  TColStd_Array1OfInteger multiplicities(1, kPoints - kDegree + 1);
  for (int k = 1; k <= kPoints - kDegree + 1; ++k)
  {
    knots(k) = k - 1;
    multiplicities(k) = k == 1 || k == kPoints - kDegree + 1 ? kDegree + 1 : 1;
  }
  return new Geom_BSplineSurface(points, weights, knots, knots, multiplicities, multiplicities,
                                 kDegree, kDegree);
}

TEST_F(CadFiles, AnOpenNurbsPatchIsToldToBeOpen)
{
  const Handle(Geom_BSplineSurface) patch = wavyPatch();
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(patch, 1e-6).Shape();
  // The oracle: the nearest of a fine raster of the patch's own points.
  constexpr int kRaster = 400;
  std::vector<Vec3> raster;
  for (int i = 0; i <= kRaster; ++i)
  {
    for (int j = 0; j <= kRaster; ++j)
    {
      const gp_Pnt p = patch->Value(4.0 * i / kRaster, 4.0 * j / kRaster);
      raster.push_back(1e-3 * Vec3(p.X(), p.Y(), p.Z()));
    }
  }
  const double chord = 5e-4;
  for (const std::string& path : {step(face), iges(face)})
  {
    const CadSurface cad = loadCadSurface(path, chord);
    EXPECT_TRUE(cad.sewn);
    EXPECT_GT(checkSurface(cad.mesh).topology.open_edges, 10u);
    EXPECT_LE(cad.deviation_m, chord);
    EXPECT_GT(cad.deviation_m, 0.05 * chord);
    double farthest = 0.0;
    for (const Triangle& t : cad.mesh.triangles)
    {
      const Vec3 middle =
          (cad.mesh.nodes[t[0]] + cad.mesh.nodes[t[1]] + cad.mesh.nodes[t[2]]) / 3.0;
      double nearest = 1.0;
      for (const Vec3& p : raster)
      {
        nearest = std::min(nearest, (p - middle).norm());
      }
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, chord + 1e-4) << "a raster point is up to 0.1 mm beside";
  }
}

TEST_F(CadFiles, FinerChordsGiveMoreTriangles)
{
  const std::string path = step(BRepPrimAPI_MakeSphere(50.0).Shape());
  const std::size_t coarse = loadCadSurface(path, 1e-3).mesh.triangles.size();
  const std::size_t fine = loadCadSurface(path, 5e-5).mesh.triangles.size();
  EXPECT_GT(fine, 10 * coarse) << "as the inverse of the chord";
}

TEST_F(CadFiles, WhatIsNoCadFileIsRefusedWithItsName)
{
  EXPECT_NE(failure(folder_.path("none.step")).find("none.step: can't be opened"),
            std::string::npos);
  EXPECT_NE(failure(folder_.write("a.stl", "solid a\nendsolid a\n")).find("neither a STEP"),
            std::string::npos);
  EXPECT_NE(failure(folder_.write("empty.step", "")).find("neither a STEP"), std::string::npos);
  const std::string cut = folder_.write("cut.step", "ISO-10303-21;\nHEADER;\n");
  EXPECT_NE(failure(cut).find("cut.step: "), std::string::npos) << failure(cut);
  const std::string good = step(BRepPrimAPI_MakeSphere(50.0).Shape());
  EXPECT_NE(failure(good, 0.0).find("chord = "), std::string::npos);
  EXPECT_NE(failure(good, std::nan("")).find("chord = "), std::string::npos);
}

}  // namespace
}  // namespace soft_tissue
