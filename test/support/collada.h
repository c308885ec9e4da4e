#pragma once

#include <sstream>
#include <string>

/**
 * A Collada file with a tet at the origin that has edges of 1, 2 and 3 units along x, y and z.
 * @param metres_per_unit  what the file says its unit is
 * @param up_axis          what the file says points up
 * @param transform        elements of the node that holds the tet
 */
inline std::string colladaTet(double metres_per_unit = 1.0, const std::string& up_axis = "Z_UP",
                              const std::string& transform = "")
{
  std::ostringstream text;
  text << R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter=")"
       << metres_per_unit << R"("/><up_axis>)" << up_axis << R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
<technique_common><accessor source="#a" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">)"
       << transform
       << R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
  return text.str();
}
