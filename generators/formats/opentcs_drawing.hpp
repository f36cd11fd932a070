#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace pugi {
class xml_node;
}

namespace fleetproof {

class XmlText;

// How a plant model draws a path.
struct DrawnPath {
  std::string connection;              // in capitals: "DIRECT", "BEZIER", ...
  std::vector<Vec2> control_points_m;  // in the coordinates of the drawing, with the y axis up
};

// The drawing of an openTCS plant model, in metres. By name of point and path. A point that is absent has no position
// of its own in the drawing.
struct OpenTcsDrawing {
  std::map<std::string, Vec2> points_m;
  std::map<std::string, DrawnPath> paths;
};

// Versions 0.0.4 and later draw with <pointLayout> and <pathLayout>. Versions 0.0.2 and 0.0.3 draw with the properties
// of <modelLayoutElement>. Control points are in units of the drawing, which `visualLayout` scales to millimetres;
// their y axis points down. Throws InputError at a number that is none, or a scale that is not positive. `warnings`
// receives what was guessed.
OpenTcsDrawing read_drawing(const XmlText& xml, const pugi::xml_node& model, std::vector<std::string>& warnings);

}  // namespace fleetproof
