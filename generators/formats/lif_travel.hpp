#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// Which end of an AGV goes first on the edges of a LIF layout. LIF 1.0 gives one orientation for each type of vehicle
// (vehicleOrientation), its successor a list (vehicleOrientations, mobileRobotOrientations) from which one is chosen.
class LifTravel {
 public:
  // Sets Segment::travel. `straight`: the way of an edge without a curve, for orientations on the map (GLOBAL). Returns
  // whether AGVs drive the edge sideways alone, so that here they drive it nose first. Throws InputError if an
  // orientation of LIF 1.0 is no angle, or relative to nothing that LIF knows.
  bool add(const std::vector<JsonReader>& rules, const std::optional<Vec2>& straight, Segment& segment);

  // What was guessed or left out, one sentence for each kind of thing.
  std::vector<std::string> sentences() const;

 private:
  // Which orientations a rule gives, in radians.
  std::vector<double> orientations(const JsonReader& rule, const std::string& edge);

  std::vector<std::string> sideways_, also_sideways_, both_ways_, unread_, large_, open_;  // names of edges
};

}  // namespace fleetproof
