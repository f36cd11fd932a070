// The shapes of openTCS paths, as they are drawn or calculated.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/scenario/layout.hpp"

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

// How the paths of an openTCS plant model run: straight, along a curve, or in straight legs with an arc at each corner.
class OpenTcsShapes {
 public:
  // Draws the segment, which has the ends of its path.
  void bend(const DrawnPath& drawn, const Layout& layout, Segment& segment);

  // Draws the polylines again. Requires: their stations may have moved, and segments may have been turned round.
  void redraw(Layout& layout) const;

  // What was straightened, rounded or aligned, one sentence for each kind of thing.
  std::vector<std::string> sentences(const Layout& layout) const;

 private:
  struct Polyline {
    StationId from{};
    std::vector<Vec2> via_m;  // in the order of the path
  };
  std::map<std::string, Polyline> polylines_;                     // by path
  std::map<std::string, std::vector<std::string>> straightened_;  // names of paths, by their connection
  std::vector<std::string> aligned_;                              // names of paths
  double largest_kink_rad_ = 0.0;
};

}  // namespace fleetproof
