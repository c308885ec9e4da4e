#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue_sim
{
/** A marker with identity pose, unit scale and opaque white colour. */
visualization_msgs::Marker makeMarker(const std::string& ns, int type);

std_msgs::ColorRGBA rgb(double r, double g, double b, double opacity = 1.0);

/** Opaque colour on a scale from tissue red over orange to yellow. @param value  in [0, 1], else
 * clamped */
std_msgs::ColorRGBA tissueColour(double value);

/** Opaque colour on a scale from dark blue over green to yellow. @param value  in [0, 1], else
 * clamped */
std_msgs::ColorRGBA depthColour(double value);

/** Area-weighted unit normals of a surface's nodes; zero where no triangle is. */
std::vector<soft_tissue::Vec3> nodeNormals(const soft_tissue::Points& nodes,
                                           const std::vector<soft_tissue::Triangle>& triangles);

/** The colour of a matt surface with this normal under a fixed light: rviz shades triangle lists
 * not. */
std_msgs::ColorRGBA lit(const std_msgs::ColorRGBA& colour, const soft_tissue::Vec3& normal);

/** Adds a triangle's corners with their colours to a TRIANGLE_LIST. */
void addCorner(visualization_msgs::Marker& marker, const soft_tissue::Vec3& p,
               const std_msgs::ColorRGBA& colour);

/**
 * Adds to a TRIANGLE_LIST where the plane x[axis] = offset cuts a tet mesh, coloured by nodal
 * depths.
 * @param depth      per node, m; tets with a NaN are left out
 * @param depth_max  m, end of the colour scale, > 0
 */
void addSlice(visualization_msgs::Marker& marker, const soft_tissue::Points& nodes,
              const std::vector<soft_tissue::Tet>& tets, const std::vector<double>& depth, int axis,
              double offset, double depth_max);

}  // namespace soft_tissue_sim
