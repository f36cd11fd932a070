#pragma once

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

}  // namespace fleetproof
