#include "core/agents/opposite_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/agents/routes.hpp"

namespace fleetproof::agents {
OppositeLanes::OppositeLanes(const MapView& map, const HullParts& parts)
    : map_(map), main_of_(map.lane_count(), FP_NONE), against_(map.lane_count(), false) {
  find_pairs(parts);
  if (pairs_.empty()) return;
  find_mains();
  goals_ = goals();
  std::set<Pair> seen;
  for (const auto& [lane, other] : pairs_) {
    const auto mains = std::minmax(main_of_[lane], main_of_[other]);
    if (mains.first != mains.second && seen.insert(mains).second) choose(mains.first, mains.second);
  }
}

void OppositeLanes::find_pairs(const HullParts& parts) {
  for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) {
    if (map_.two_way(lane)) continue;
    const std::uint32_t end = map_.lane(lane).to;
    const Vec heading = map_.end_heading(lane);
    for (const std::uint32_t other : parts.lanes_blocked_by_turning(end)) {
      const bool touches = map_.lane(other).from == end || map_.lane(other).to == end;
      const bool opposite =
          opposite_heading(map_.start_heading(other), heading) || opposite_heading(map_.end_heading(other), heading);
      if (touches || !opposite || map_.two_way(other) || !parts.standing_blocks_lane(end, heading, other)) continue;
      pairs_.emplace_back(lane, other);
    }
  }
}

void OppositeLanes::find_mains() {
  std::vector<std::uint32_t> open;
  const auto visit = [&](std::uint32_t lane, std::uint32_t main) {
    if (map_.two_way(lane) || main_of_[lane] != FP_NONE) return;
    main_of_[lane] = main;
    open.push_back(lane);
  };
  for (std::uint32_t first = 0; first < map_.lane_count(); ++first) {
    visit(first, first);
    while (!open.empty()) {
      const std::uint32_t lane = open.back();
      open.pop_back();
      for (const std::uint32_t next : map_.lanes_from(map_.lane(lane).to)) {
        if (same_heading(map_.end_heading(lane), map_.start_heading(next))) visit(next, main_of_[lane]);
      }
      for (const std::uint32_t before : map_.lanes_to(map_.lane(lane).from)) {
        if (same_heading(map_.end_heading(before), map_.start_heading(lane))) visit(before, main_of_[lane]);
      }
    }
  }
}

void OppositeLanes::choose(std::uint32_t main, std::uint32_t other) {
  if (ways_m(main, other) <= ways_m(other, main)) {
    price(main, other, true);
  } else {
    price(other, main, true);
  }
}

// Between some of the goals, if `main` is the dearer one where it runs beside `other`.
double OppositeLanes::ways_m(std::uint32_t main, std::uint32_t other) {
  const std::vector<bool> before = against_;
  price(main, other, true);
  const DriveRules rules(map_, 0);
  const double sum_m = rules.any() ? ways_by_rules_m(rules) : ways_without_rules_m();
  against_ = before;
  return sum_m;
}

double OppositeLanes::ways_by_rules_m(const DriveRules& rules) const {
  std::vector<double> costs_m;
  for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) costs_m.push_back(cost_m(lane));
  Routes routes(map_, rules);
  double sum_m = 0.0;
  for (const std::uint32_t from : goals_) {
    routes.search(from, {1.0, 0.0}, costs_m);
    for (const std::uint32_t to : goals_) sum_m += routes.cost_s(to) < INFINITY ? routes.cost_s(to) : 0.0;
  }
  return sum_m;
}

double OppositeLanes::ways_without_rules_m() {
  if (least_ == nullptr) {
    std::vector<double> costs_m;
    for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) costs_m.push_back(map_.lane(lane).length_m);
    least_ = std::make_unique<LeastCosts>(map_, costs_m, false);
  }
  for (const auto& [one, two] : pairs_) least_->change(one, cost_m(one)), least_->change(two, cost_m(two));
  double sum_m = 0.0;
  for (const std::uint32_t from : goals_) {
    const std::vector<double> ways_m = least_->from(from);
    for (const std::uint32_t to : goals_) sum_m += ways_m[to] < INFINITY ? ways_m[to] : 0.0;
  }
  return sum_m;
}

double OppositeLanes::cost_m(std::uint32_t lane) const {
  return map_.lane(lane).length_m * (against_[lane] ? kPrice : 1.0);
}

void OppositeLanes::price(std::uint32_t main, std::uint32_t other, bool against) {
  for (const auto& [one, two] : pairs_) {
    if (main_of_[one] == main && main_of_[two] == other) against_[one] = against;
    if (main_of_[two] == main && main_of_[one] == other) against_[two] = against;
  }
}

std::vector<std::uint32_t> OppositeLanes::goals() const {
  std::vector<std::uint32_t> all, some;
  for (std::uint32_t station = 0; station < map_.station_count(); ++station) {
    if (map_.station(station).purposes != FP_ROUTING) all.push_back(station);
  }
  const std::size_t count = std::min(kGoals, all.size());
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

std::span<const std::uint8_t> lanes_against_opposite(const HullParts& parts) {
  return ask<std::uint8_t>(
      parts.facts(),
      [](const fp_facts* facts, std::uint64_t question, fp_answer* to) {
        const MapView map(*facts);
        std::vector<std::uint8_t> against(map.lane_count(), 0);
        if (facts->fleet_count > 1) {
          const OppositeLanes lanes(map, HullParts(map, *facts, HullKey(question)));
          for (std::uint32_t id = 0; id < map.lane_count(); ++id) against[id] = lanes.is_against(id) ? 1 : 0;
        }
        answer(*facts, to, against);
      },
      parts.key().question(0));
}

}  // namespace fleetproof::agents
