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

double lane_speed_mps(const MapView& map, std::uint32_t lane, const fp_agv& agv) {
  const bool own = map.is_backward(lane) && agv.reverse_speed_mps > 0.0;
  const double speed_mps = own ? agv.reverse_speed_mps : agv.speed_mps;
  const double limit_mps = map.tells_rules() ? map.lane(lane).speed_limit_mps : 0.0;
  return limit_mps > 0.0 ? std::min(speed_mps, limit_mps) : speed_mps;
}

double lane_time_s(const MapView& map, std::uint32_t lane, const fp_agv& agv) {
  fp_agv limited = agv;
  limited.speed_mps = lane_speed_mps(map, lane, agv);
  return drive_time_s(map.lane(lane).length_m, limited);
}

// The cheapest is at the top of the heap; of equals, the one with the smallest number.
constexpr auto is_dearer = [](const auto& a, const auto& b) {
  return a.cost_s > b.cost_s || (a.cost_s == b.cost_s && a.place > b.place);
};

Routes::Routes(const MapView& map, const DriveRules& rules) : map_(map), rules_(rules) {
  if (map.facts() == nullptr) {
    own_ = hops_of(map);
    read(own_);
    return;
  }
  read(ask<std::byte>(
      *map.facts(),
      [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, hops_of(MapView(*from))); }, 0));
}

std::vector<std::byte> Routes::hops_of(const MapView& map) {
  std::vector<Hop> hops;
  std::vector<std::uint32_t> first_hops;
  hops.reserve(map.lane_count()), first_hops.reserve(map.station_count() + 1);
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    first_hops.push_back(static_cast<std::uint32_t>(hops.size()));
    for (const std::uint32_t lane : map.lanes_from(station)) hops.push_back({lane, map.lane(lane).to});
  }
  first_hops.push_back(static_cast<std::uint32_t>(hops.size()));
  TableWriter tables;
  tables.add(hops, first_hops);
  return tables.bytes();
}

void Routes::read(std::span<const std::byte> tables) {
  TableReader reader(tables);
  hops_ = reader.next<Hop>();
  first_hops_ = reader.next<std::uint32_t>();
}

// The cheapest of what was pushed since the last pop is often the next one: it stays out of the heap.
void Routes::push(Open open) {
  if (!has_next_) {
    has_next_ = true;
    next_ = open;
    return;
  }
  if (is_dearer(next_, open)) std::swap(next_, open);
  open_.push_back(open);
  std::ranges::push_heap(open_, is_dearer);
}

Routes::Open Routes::pop() {
  if (has_next_ && (open_.empty() || is_dearer(open_.front(), next_))) {
    has_next_ = false;
    return next_;
  }
  std::ranges::pop_heap(open_, is_dearer);
  const Open cheapest = open_.back();
  open_.pop_back();
  return cheapest;
}

void Routes::search(std::uint32_t from, Vec heading, std::span<const double> cost_s, std::uint32_t until) {
  search(from, heading, cost_s, Aim{until, {}, nullptr, {}});
}

void Routes::search_towards(std::uint32_t until, std::span<const float> remains_s, std::uint32_t from, Vec heading,
                            std::span<const double> cost_s, double far_m) {
  search(from, heading, cost_s, Aim{until, remains_s, nullptr, map_.position_m(from), far_m});
}

void Routes::search_until(const Enough& enough, std::uint32_t from, Vec heading, std::span<const double> cost_s) {
  search(from, heading, cost_s, Aim{FP_NONE, {}, &enough, {}});
}

void Routes::search(std::uint32_t from, Vec heading, std::span<const double> cost_s, const Aim& aim) {
  if (searches_++ == 0) {  // many never search: their ways come from elsewhere
    places_.resize(map_.station_count());
    lanes_driven_.resize(rules_.any() ? map_.lane_count() : 0);
  }
  reached_ = FP_NONE;
  open_.clear();
  has_next_ = false;
  // With a heading with which it may not stay, an AGV is not there yet.
  if (map_.may_stay(from, heading)) places_[from] = {0.0, FP_NONE, searches_};
  rules_.any() ? search_lanes(from, heading, cost_s, aim) : search_stations(from, cost_s, aim);
}

bool Routes::is_enough(std::uint32_t station, double cost_s, const Aim& aim) const {
  const bool is_far = aim.far_m < INFINITY && length(map_.position_m(station) - aim.begin_m) >= aim.far_m;
  return is_far || (aim.enough != nullptr && (*aim.enough)(station, cost_s));
}

void Routes::search_stations(std::uint32_t from, std::span<const double> cost_s, const Aim& aim) {
  if (is_reached(from, 0.0, aim)) return;
  leave(from, 0.0, cost_s, aim);
  while (has_next_ || !open_.empty()) {
    const auto [bound_s, here] = pop();
    const double so_far_s = places_[here].cost_s;
    if (bound_s > so_far_s + aim.remains(here)) continue;
    if (is_reached(here, so_far_s, aim)) return;
    leave(here, so_far_s, cost_s, aim);
  }
}

void Routes::leave(std::uint32_t station, double so_far_s, std::span<const double> cost_s, const Aim& aim) {
  for (std::uint32_t hop = first_hops_[station]; hop < first_hops_[station + 1]; ++hop) {
    const auto [lane, to] = hops_[hop];
    const double cost = so_far_s + cost_s[lane];
    if (cost >= this->cost_s(to)) continue;
    places_[to] = {cost, lane, searches_};
    push({cost + aim.remains(to), to});
  }
}

void Routes::search_lanes(std::uint32_t from, Vec heading, std::span<const double> cost_s, const Aim& aim) {
  for (const std::uint32_t lane : map_.lanes_from(from)) {
    if (rules_.may_leave(heading, lane)) reach(lane, cost_s[lane], FP_NONE, aim);
  }
  while (has_next_ || !open_.empty()) {
    const auto [bound_s, here] = pop();
    const std::uint32_t station = map_.lane(here).to;
    const double so_far_s = lanes_driven_[here].cost_s;
    if (bound_s > so_far_s + aim.remains(station)) continue;
    if (so_far_s < this->cost_s(station) && map_.may_stay(station, map_.end_heading(here))) {
      places_[station] = {so_far_s, here, searches_};
      if (is_reached(station, so_far_s, aim)) return;
    }
    for (const std::uint32_t next : map_.lanes_from(station)) {
      if (rules_.may_leave(map_.end_heading(here), next)) reach(next, so_far_s + cost_s[next], here, aim);
    }
  }
}

void Routes::reach(std::uint32_t lane, double cost_s, std::uint32_t before, const Aim& aim) {
  if (cost_s >= (is_driven(lane) ? lanes_driven_[lane].cost_s : INFINITY)) return;
  lanes_driven_[lane] = {cost_s, before, searches_};
  push({cost_s + aim.remains(map_.lane(lane).to), lane});
}

std::span<const std::uint32_t> Routes::lanes(std::uint32_t to) {
  lanes_.clear();
  const auto arrival = [&](std::uint32_t station) { return is_found(station) ? places_[station].arrival : FP_NONE; };
  const auto before = [&](std::uint32_t lane) {
    return rules_.any() ? lanes_driven_[lane].arrival : arrival(map_.lane(lane).from);
  };
  for (std::uint32_t lane = arrival(to); lane != FP_NONE; lane = before(lane)) lanes_.push_back(lane);
  std::ranges::reverse(lanes_);
  return lanes_;
}

}  // namespace fleetproof::agents
