#include "core/agents/waiting_places.hpp"

#include <algorithm>

namespace fleetproof::agents {

std::uint32_t WaitingPlaces::burden(std::uint32_t station) {
  std::uint32_t& known = burdens_[station];
  if (known != kUnknown) return known;
  std::uint32_t burden = 0;
  const bool all_one_way =
      std::ranges::none_of(map_.lanes_from(station), [&](std::uint32_t lane) { return map_.two_way(lane); }) &&
      std::ranges::none_of(map_.lanes_to(station), [&](std::uint32_t lane) { return map_.two_way(lane); });
  if (!all_one_way) burden += stations_cut_off(station);
  if (!leaves_lanes_clear(station)) burden += kFoulsLanes;
  known = burden;
  return burden;
}

bool WaitingPlaces::leaves_lanes_clear(std::uint32_t station) {
  for (std::uint32_t id = 0; id < map_.lane_count(); ++id) {
    const fp_lane& lane = map_.lane(id);
    if (lane.from != station && lane.to != station && geometry_.turning_blocks_lane(station, id)) return false;
  }
  return true;
}

std::uint32_t WaitingPlaces::stations_cut_off(std::uint32_t station) {
  if (is_dead_end(station)) return 0;
  const std::uint32_t before = strongly_connected_with(station, FP_NONE);
  std::uint32_t largest = 0;
  const auto try_from = [&](std::uint32_t neighbour) {
    if (neighbour != station && largest + 1 < before)
      largest = std::max(largest, strongly_connected_with(neighbour, station));
  };
  for (const std::uint32_t lane : map_.lanes_from(station)) try_from(map_.lane(lane).to);
  for (const std::uint32_t lane : map_.lanes_to(station)) try_from(map_.lane(lane).from);
  return largest + 1 >= before ? 0 : before - 1 - largest;
}

bool WaitingPlaces::is_dead_end(std::uint32_t station) const {
  const auto leaving = map_.lanes_from(station);
  const std::uint32_t only = leaving.empty() ? FP_NONE : map_.lane(leaving.front()).to;
  return std::ranges::all_of(leaving, [&](std::uint32_t lane) { return map_.lane(lane).to == only; }) &&
         std::ranges::all_of(map_.lanes_to(station), [&](std::uint32_t lane) { return map_.lane(lane).from == only; });
}

std::uint32_t WaitingPlaces::strongly_connected_with(std::uint32_t from, std::uint32_t without) {
  marks_.assign(map_.station_count(), 0);
  mark_reachable(from, without, false);
  mark_reachable(from, without, true);
  return static_cast<std::uint32_t>(std::ranges::count(marks_, 3));
}

void WaitingPlaces::mark_reachable(std::uint32_t from, std::uint32_t without, bool backwards) {
  const std::uint8_t mark = backwards ? 2 : 1;
  marks_[from] = static_cast<std::uint8_t>(marks_[from] | mark);
  stack_.assign(1, from);
  while (!stack_.empty()) {
    const std::uint32_t at = stack_.back();
    stack_.pop_back();
    for (const std::uint32_t lane : backwards ? map_.lanes_to(at) : map_.lanes_from(at)) {
      const std::uint32_t next = backwards ? map_.lane(lane).from : map_.lane(lane).to;
      if (next == without || (marks_[next] & mark) != 0) continue;
      marks_[next] = static_cast<std::uint8_t>(marks_[next] | mark);
      stack_.push_back(next);
    }
  }
}

}  // namespace fleetproof::agents
