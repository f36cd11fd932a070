#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/markup/markup.hpp"

namespace fleetproof::html {

// A place on the floor, in metres.
struct FloorPoint {
  double x_m = 0.0, y_m = 0.0;
};

// A body seen from above. The length is along the heading, a unit vector.
struct FilmBody {
  std::string name;
  FloorPoint centre, heading{1.0, 0.0};
  double length_m = 0.0, width_m = 0.0;
  bool is_agv = true;
  bool is_involved = false;  // in what went wrong
};

struct FilmFrame {
  double time_s = 0.0;  // as shown_seconds has it
  bool is_worst = false;
  std::optional<double> clearance_m;  // between the two bodies involved; 0: they touch
  std::string without_clearance{};    // why there is none, in a few words; empty if only one body is involved
  std::vector<FilmBody> bodies;
};

// Some seconds of one run. Without frames, `note` says why there are none.
struct FilmStrip {
  std::string note;
  std::vector<FilmFrame> frames;  // in order of time
  std::vector<std::vector<FloorPoint>> lanes;
  std::vector<FloorPoint> stations;
  double safety_distance_m = 0.0;  // drawn around the bodies involved
  double least_side_m = 6.0;       // of the part of the floor that is shown
};

// All frames show the same part of the floor, so that one sees what moved: the bodies involved with some room around
// them, or all AGVs if no body is involved. Of frames in a row that would look the same, one is drawn.
Element draw(const FilmStrip& strip);

}  // namespace fleetproof::html
