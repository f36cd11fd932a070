#include "laws/approach.hpp"

#include <algorithm>
#include <limits>

#include "core/scenario/ways.hpp"

namespace fleetproof {

Approach::Approach(const Scenario& scenario) : map_(*scenario.map), been_at_(scenario.agvs.size()) {
  for (const AgvSetup& agv : scenario.agvs) here_.push_back(agv.start);
  begin_anew();
}

void Approach::drive_begins(EntityId agv, SegmentId segment) {
  if (segment.index() >= map_.segment_count()) return;
  const Segment& driven = map_.segment(segment);
  StationId& here = here_[agv.index()];
  if (here != driven.from && here != driven.to) return;
  here = here == driven.from ? driven.to : driven.from;
  std::vector<StationId>& been_at = been_at_[agv.index()];
  if (std::ranges::find(been_at, here) == been_at.end()) been_at.push_back(here);
}

void Approach::set_down(EntityId agv, StationId at) {
  here_[agv.index()] = at;
  been_at_[agv.index()] = {at};
}

void Approach::begin_anew() {
  for (std::size_t i = 0; i < here_.size(); ++i) been_at_[i] = {here_[i]};
}

double Approach::gained_m(EntityId agv, StationId goal) {
  const std::vector<StationId>& been_at = been_at_[agv.index()];
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const StationId station : been_at) nearest_m = std::min(nearest_m, length_m(station, goal));
  const double before_m = length_m(been_at.front(), goal);
  return before_m < std::numeric_limits<double>::infinity() ? before_m - nearest_m : 0.0;
}

double Approach::length_m(StationId from, StationId to) {
  const auto [known, is_new] = lengths_m_.try_emplace({from, to}, std::numeric_limits<double>::infinity());
  if (is_new) {
    const ShortestWay way = shortest_ways(map_, from, to).back();
    if (way.to == to) known->second = way.length_m;
  }
  return known->second;
}

}  // namespace fleetproof
