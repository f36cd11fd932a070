#include "core/scenario/ways.hpp"

#include <limits>
#include <queue>
#include <utility>

namespace fleetproof {
namespace {

// The nearest station first, of equals by number.
class NearestFirst {
 public:
  using Open = std::pair<double, std::uint32_t>;

  void push(const Open& open) { heap_.push(open); }
  bool empty() const { return heap_.empty(); }
  Open pop() {
    const Open nearest = heap_.top();
    heap_.pop();
    return nearest;
  }

 private:
  std::priority_queue<Open, std::vector<Open>, std::greater<>> heap_;
};

// A map whose lanes are driven from their ends to their beginnings.
class Reversed {
 public:
  explicit Reversed(const LogicalMap& map) : lanes_into_(map.station_count()) {
    for (std::uint32_t i = 0; i < map.lanes().size(); ++i) lanes_into_[map.lanes()[i].to.index()].push_back(i);
  }
  std::size_t station_count() const { return lanes_into_.size(); }
  const std::vector<std::uint32_t>& lanes_from(StationId station) const { return lanes_into_[station.index()]; }

 private:
  std::vector<std::vector<std::uint32_t>> lanes_into_;  // by station
};

}  // namespace

std::vector<ShortestWay> shortest_ways(const LogicalMap& map, StationId from, StationId until, const LaneRules* rules) {
  std::vector<ShortestWay> ways;
  visit_shortest_ways(map, from, rules, [&](const ShortestWay& way) {
    ways.push_back(way);
    return way.to != until;
  });
  return ways;
}

void visit_shortest_ways(const LogicalMap& map, StationId from, const LaneRules* rules,
                         const std::function<bool(const ShortestWay&)>& visit) {
  std::vector<const Lane*> first(map.station_count(), nullptr);
  std::vector<ReachedStation<double>> reached;
  NearestFirst open;
  const auto hop = [&](std::uint32_t index) {
    const Lane& lane = map.lanes()[index];
    const bool permitted = rules == nullptr || map.segment(lane.segment).permits(rules->vehicle_type, rules->loaded);
    return std::pair(lane.to.value, permitted ? lane.curve.length_m() : std::numeric_limits<double>::infinity());
  };
  search_ways(map, from, open, reached, hop, [&](StationId station) {
    const auto& [length_m, next_best, index] = reached[station.index()];
    const Lane* last = index == kNoLane ? nullptr : &map.lanes()[index];
    if (last != nullptr) first[station.index()] = last->from == from ? last : first[last->from.index()];
    return visit({station, length_m, first[station.index()], last});
  });
}

std::vector<double> lengths_to(const LogicalMap& map, StationId goal) {
  std::vector<double> lengths_m(map.station_count(), std::numeric_limits<double>::infinity());
  std::vector<ReachedStation<double>> reached;
  NearestFirst open;
  const auto hop = [&](std::uint32_t index) {
    const Lane& lane = map.lanes()[index];
    return std::pair(lane.from.value, lane.curve.length_m());
  };
  search_ways(Reversed(map), goal, open, reached, hop, [&](StationId station) {
    lengths_m[station.index()] = reached[station.index()].cost;
    return true;
  });
  return lengths_m;
}

}  // namespace fleetproof
