#include "core/agents/routes.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof::agents {

double drive_time_s(double length_m, const fp_agv& agv) {
  const double a = agv.acceleration_mps2, d = agv.deceleration_mps2, v = agv.speed_mps;
  const double ramps_m = v * v / (2.0 * a) + v * v / (2.0 * d);
  if (length_m < ramps_m) return std::sqrt(2.0 * length_m * (a + d) / (a * d));
  return v / a + v / d + (length_m - ramps_m) / v;
}

Routes::Routes(const MapView& map) : map_(map) {
  hops_.reserve(map.lane_count());
  first_hops_.reserve(map.station_count() + 1);
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    first_hops_.push_back(static_cast<std::uint32_t>(hops_.size()));
    for (const std::uint32_t lane : map.lanes_from(station)) hops_.push_back({lane, map.lane(lane).to});
  }
  first_hops_.push_back(static_cast<std::uint32_t>(hops_.size()));
}

void Routes::search(std::uint32_t from, std::span<const double> cost_s, std::uint32_t until) {
  const auto dearer = [](const Open& a, const Open& b) {
    return a.cost_s > b.cost_s || (a.cost_s == b.cost_s && a.station > b.station);
  };
  cost_s_.assign(map_.station_count(), INFINITY);
  arrival_.assign(map_.station_count(), FP_NONE);
  open_.assign(1, {0.0, from});
  cost_s_[from] = 0.0;
  while (!open_.empty()) {
    std::ranges::pop_heap(open_, dearer);
    const Open here = open_.back();
    open_.pop_back();
    if (here.station == until) return;
    if (here.cost_s > cost_s_[here.station]) continue;
    for (std::uint32_t hop = first_hops_[here.station]; hop < first_hops_[here.station + 1]; ++hop) {
      const auto [lane, to] = hops_[hop];
      const double cost = here.cost_s + cost_s[lane];
      if (cost >= cost_s_[to]) continue;
      cost_s_[to] = cost;
      arrival_[to] = lane;
      open_.push_back({cost, to});
      std::ranges::push_heap(open_, dearer);
    }
  }
}

std::span<const std::uint32_t> Routes::lanes(std::uint32_t to) {
  lanes_.clear();
  for (std::uint32_t lane = arrival_[to]; lane != FP_NONE; lane = arrival_[map_.lane(lane).from])
    lanes_.push_back(lane);
  std::ranges::reverse(lanes_);
  return lanes_;
}

}  // namespace fleetproof::agents
