#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/agents/drive_rules.hpp"
#include "core/agents/map_view.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// The time that AGVs of this type need for a lane, from rest to rest, without turns.
double drive_time_s(double length_m, const fp_agv& agv);

// The top speed of such an AGV on a lane of the map: that of its direction, forward or backward, with the limit of the
// lane.
double lane_speed_mps(const MapView& map, std::uint32_t lane, const fp_agv& agv);

// The time for a lane, from rest to rest.
double lane_time_s(const MapView& map, std::uint32_t lane, const fp_agv& agv);

// The quickest ways from one station to all others (Dijkstra). A search reuses the memory of the search before it. In a
// plant with rules, the ways keep them: what comes next then depends on the lane by which the AGV has come.
class Routes {
 public:
  Routes(const MapView& map, const DriveRules& rules);

  // `cost_s` by lane; infinite where the AGV must not drive. `heading`: of the AGV at the beginning. With `until`, no
  // further than to that station: its way is the same as that of a whole search, and only its way may be asked for.
  void search(std::uint32_t from, Vec heading, std::span<const double> cost_s, std::uint32_t until = FP_NONE);
  // The same; if several ways have the same cost, it finds one of them. `remains_s`, by station: the way from there to
  // `until` costs so much at least. The nearer this is to the truth, the fewer stations are looked at (A*).
  // It ends at the first station that is `far_m` away, if that is before `until`: then what remains decides.
  void search_towards(std::uint32_t until, std::span<const float> remains_s, std::uint32_t from, Vec heading,
                      std::span<const double> cost_s, double far_m = INFINITY);
  // Where the last search with an aim ended; FP_NONE if there is no way.
  std::uint32_t reached() const { return reached_; }
  // Shows the stations that can be reached, the cheapest first, until `enough` says true. Afterwards, the ways to the
  // stations that were shown may be asked for.
  using Enough = std::function<bool(std::uint32_t station, double cost_s)>;
  void search_until(const Enough& enough, std::uint32_t from, Vec heading, std::span<const double> cost_s);
  // Of the last search. Infinite if there is no way.
  double cost_s(std::uint32_t to) const { return is_found(to) ? places_[to].cost_s : INFINITY; }
  // A lane that leaves a station. In a plant, the lanes of the map are too far apart in memory for a search.
  struct Hop {
    std::uint32_t lane, to;
  };
  std::span<const Hop> hops_from(std::uint32_t station) const {
    return hops_.subspan(first_hops_[station], first_hops_[station + 1] - first_hops_[station]);
  }

  // The lanes to drive; empty if there is no way, or if `to` is where the search began. Valid until the next call.
  std::span<const std::uint32_t> lanes(std::uint32_t to);

 private:
  struct Open {
    double cost_s;        // of the way there, and what remains at least
    std::uint32_t place;  // a station; in a plant with rules, a lane that has been driven
  };
  // What a search looks for.
  struct Aim {
    std::uint32_t until = FP_NONE;
    std::span<const float> remains_s;  // by station; may be empty
    const Enough* enough = nullptr;
    Vec begin_m;
    double far_m = INFINITY;

    double remains(std::uint32_t station) const { return remains_s.empty() ? 0.0 : remains_s[station]; }
    bool is_station_only() const { return enough == nullptr && far_m == INFINITY; }
  };

  // What a search has found. Those of earlier searches are forgotten by their number: a map has many.
  struct Found {
    double cost_s = 0.0;
    std::uint32_t arrival = 0;  // of a station: the lane by which the way arrives; of a lane: the lane before it
    std::uint32_t search = 0;
  };

  bool is_found(std::uint32_t station) const { return places_[station].search == searches_; }
  bool is_driven(std::uint32_t lane) const { return lanes_driven_[lane].search == searches_; }
  static std::vector<std::byte> hops_of(const MapView& map);
  void read(std::span<const std::byte> tables);
  void search(std::uint32_t from, Vec heading, std::span<const double> cost_s, const Aim& aim);
  void search_stations(std::uint32_t from, std::span<const double> cost_s, const Aim& aim);
  void leave(std::uint32_t station, double so_far_s, std::span<const double> cost_s, const Aim& aim);
  void search_lanes(std::uint32_t from, Vec heading, std::span<const double> cost_s, const Aim& aim);
  void reach(std::uint32_t lane, double cost_s, std::uint32_t before, const Aim& aim);
  bool is_reached(std::uint32_t station, double cost_s, const Aim& aim) {
    if (station != aim.until && (aim.is_station_only() || !is_enough(station, cost_s, aim))) return false;
    reached_ = station;
    return true;
  }
  bool is_enough(std::uint32_t station, double cost_s, const Aim& aim) const;
  void push(Open open);
  Open pop();

  const MapView& map_;
  const DriveRules& rules_;
  std::vector<std::byte> own_;                 // the hops, if they are not shared
  std::span<const Hop> hops_;                  // by station
  std::span<const std::uint32_t> first_hops_;  // by station, and one more: where its hops begin
  std::uint32_t searches_ = 0, reached_ = FP_NONE;
  std::vector<Found> places_;        // by station
  std::vector<Found> lanes_driven_;  // in a plant with rules, by lane: up to its end
  std::vector<Open> open_;           // heap, cheapest first
  Open next_{};                      // and one outside it
  bool has_next_ = false;
  std::vector<std::uint32_t> lanes_;
};

}  // namespace fleetproof::agents
