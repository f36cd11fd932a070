// How vehicles travel on an edge of LIF: orientation, turns, speed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// What the edges of a LIF layout say about turns at their nodes. Rules that differ hold together, so no AGV may turn at
// a node if no edge that arrives there lets it, or no edge that leaves. An AGV that may turn on an edge, or that drives
// it sideways, turns at its ends here.
class LifTurns {
 public:
  void add(const JsonReader& edge, StationId from, StationId to, bool sideways);

  // Sets Station::turning. Returns a sentence for each kind of rule that a station has no place for.
  std::vector<std::string> settle(Layout& layout);

 private:
  struct Ends {
    std::size_t all = 0, never = 0;  // edges, and those that let no AGV turn

    bool forbid() const { return all > 0 && never == all; }
    bool differ() const { return never > 0 && never < all; }
  };
  struct Node {
    Ends arriving, leaving;
    bool one_way_round = false, some_may = false;
  };
  void add_end(const JsonReader& edge, const char* key, Node& node, Ends Node::*ends, bool sideways);

  Node& node(StationId station);

  std::vector<Node> nodes_;  // by station
};

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
