#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/scenario/lane_rules.hpp"

namespace fleetproof {

// The one search for best ways over the lanes of a map (Dijkstra). What a way costs and which queue holds the open
// stations is the caller's choice: the operator and the laws ask for lengths, the timetable of the generators for times
// in whole nanoseconds with a queue of its own (generators/map/timetable.hpp).
inline constexpr std::uint32_t kNoLane = ~std::uint32_t{0};

template <class Cost>
struct ReachedStation {
  static constexpr Cost kFar = std::numeric_limits<Cost>::max();

  Cost cost = kFar;              // of the best way; kFar: none leads here
  Cost next_best = kFar;         // of the best way that ends with another lane
  std::uint32_t lane = kNoLane;  // with which the best way ends; kNoLane at the start and where no way leads
};

// Finds the best ways from `from` to all stations, into `reached` (by station). Of ways that cost the same the one that
// is found first stays.
//
// `open` is an empty queue: push({cost, station}); pop() gives such a pair with the least cost; empty().
// `hop` gives {station, cost} of a lane: where it leads, and what it costs; no cost is below zero.
// `arrive(station)` is called for each station in order of cost, when its way is final; false ends the search.
// `map` is a LogicalMap, or says as one does how many stations there are, and which lanes leave each.
template <class Map, class Cost, class Queue, class Hop, class Arrive>
void search_ways(const Map& map, StationId from, Queue& open, std::vector<ReachedStation<Cost>>& reached,
                 const Hop& hop, const Arrive& arrive) {
  reached.assign(map.station_count(), {});
  reached[from.index()].cost = Cost{};
  open.push({Cost{}, from.value});
  while (!open.empty()) {
    const auto [cost, here] = open.pop();
    if (cost > reached[here].cost) continue;  // a better way was found since
    if (!arrive(StationId{here})) return;
    for (const std::uint32_t lane : map.lanes_from(StationId{here})) {
      const auto [next, hop_cost] = hop(lane);
      ReachedStation<Cost>& there = reached[next];
      const Cost whole = cost + hop_cost;
      if (whole < there.cost) {
        there = {whole, there.cost, lane};
        open.push({whole, next});
      } else if (whole < there.next_best) {
        there.next_best = whole;
      }
    }
  }
}

// A shortest way, by the length of its lanes.
struct ShortestWay {
  StationId to;
  double length_m = 0.0;
  const Lane* first = nullptr;  // null: the way to the start itself
  const Lane* last = nullptr;   // null: the way to the start itself
};

// The shortest ways from a station to all that can be reached, by length, of equals by number; `from` itself is the
// first. With `until`, no further than to that station. With `rules`, over lanes only for which the AGV has permission,
// whatever its heading.
std::vector<ShortestWay> shortest_ways(const LogicalMap& map, StationId from, StationId until = {},
                                       const LaneRules* rules = nullptr);

// The same ways, one after the other, until `visit` returns false: nothing is sought beyond.
void visit_shortest_ways(const LogicalMap& map, StationId from, const LaneRules* rules,
                         const std::function<bool(const ShortestWay&)>& visit);

// How far each station is from the goal, along the shortest way; infinity if no way leads there. By station.
std::vector<double> lengths_to(const LogicalMap& map, StationId goal);

}  // namespace fleetproof
