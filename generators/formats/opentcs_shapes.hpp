#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/opentcs_drawing.hpp"

namespace fleetproof {

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
