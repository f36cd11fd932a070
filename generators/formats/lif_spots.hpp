#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// LIF has edges of no length: on them, an AGV turns where it stands, from one node to another at the same place. Here
// the nodes that such edges join are one station, which has the name of the first.
class LifSpots {
 public:
  // Whether an AGV stays where it is on this edge, which leads from one of these places to the other.
  static bool stays(const JsonReader& edge, const Vec2& from_m, const Vec2& to_m);

  // An edge on which an AGV stays. Stations are as yet those of the nodes. `for_all`: whether every AGV may use it.
  void add(const JsonReader& edge, StationId from, StationId to, bool for_all);

  // Gives the nodes of each spot the purposes of all of them. Notes first which of them had any.
  void share_purposes(Layout& layout);

  // Makes one station of the nodes of each spot, and takes the others out of `nodes`, too, which is by station. Adds
  // the sentences that say so.
  void join(Layout& layout, std::vector<JsonReader>& nodes, std::vector<std::string>& warnings);

 private:
  struct Turn {
    std::size_t node = 0;
    bool on_edge = false, for_all = false, limited = false;
  };
  struct Spot {
    std::vector<std::size_t> nodes;  // ascending
    bool turns = false, for_all = true, limited = false;
  };
  void note_tasks(const Layout& layout, const Spot& spot);
  // For which the nodes with tasks ask, or all nodes if none has tasks. None: they ask for none, or for several.
  std::optional<Vec2> heading_of(const Layout& layout, const Spot& spot) const;
  void unite(Layout& layout, const Spot& spot) const;
  std::size_t first_of(std::size_t node);
  std::map<std::size_t, Spot> spots();
  // Each spot has one station; `spots` is by that station.
  void tell(const Layout& layout, const std::map<std::size_t, Spot>& spots, std::vector<std::string>& warnings) const;

  std::map<std::size_t, std::size_t> earlier_;  // by node: an earlier one of the same spot; the first: itself
  std::vector<Turn> turns_;
  std::set<std::size_t> with_tasks_;  // nodes
  std::string place_;                 // of the first edge
};

}  // namespace fleetproof
