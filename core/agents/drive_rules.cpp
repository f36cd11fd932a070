#include "core/agents/drive_rules.hpp"

#include <algorithm>

namespace fleetproof::agents {
namespace {

constexpr std::size_t kMostTried = 64;

}  // namespace

DriveRules::DriveRules(const MapView& map, std::uint32_t vehicle_type, WorkOut)
    : map_(map), vehicle_type_(vehicle_type) {
  if (has_rules()) keep_those_that_lead_back();
}

DriveRules::DriveRules(const MapView& map, std::uint32_t vehicle_type) : map_(map), vehicle_type_(vehicle_type) {
  if (map.facts() == nullptr) {
    own_ = DriveRules(map, vehicle_type, WorkOut{}).own_;
    usable_ = own_;
    return;
  }
  usable_ = ask<std::uint8_t>(
      *map.facts(),
      [](const fp_facts* from, std::uint64_t type, fp_answer* to) {
        const MapView shared(*from);
        answer(*from, to, DriveRules(shared, static_cast<std::uint32_t>(type), WorkOut{}).own_);
      },
      vehicle_type);
}

bool DriveRules::has_rules() const {
  for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) {
    if (!map_.permits(lane, vehicle_type_, false) || !map_.permits(lane, vehicle_type_, true)) return true;
  }
  for (std::uint32_t station = 0; station < map_.station_count(); ++station) {
    if (!map_.may_turn(station) || map_.asks_for_a_heading(station)) return true;
  }
  return false;
}

bool DriveRules::leads_to(std::uint32_t state, std::uint32_t next) const {
  const std::uint32_t lane = state / 2, next_lane = next / 2;
  if (lane == next_lane) return map_.may_stay(map_.lane(lane).to, map_.end_heading(lane));  // takes up or puts down
  return state % 2 == next % 2 && permits(next) &&
         (map_.may_turn(map_.lane(lane).to) || same_heading(map_.end_heading(lane), map_.start_heading(next_lane)));
}

// All states that can be reached from one, or from which it can be reached; the state itself among them. Without
// transfers: only through states that are kept.
DriveRules::States DriveRules::connected(std::uint32_t from, bool backwards, bool transfers) const {
  States seen(2 * map_.lane_count(), false);
  std::vector<std::uint32_t> open{from};
  seen[from] = true;
  const auto visit = [&](std::uint32_t here, std::uint32_t there) {
    if (seen[there] || (!transfers && own_[there] == 0)) return;
    if (!(backwards ? leads_to(there, here) : leads_to(here, there))) return;
    seen[there] = true;
    open.push_back(there);
  };
  while (!open.empty()) {
    const std::uint32_t here = open.back();
    open.pop_back();
    const fp_lane& lane = map_.lane(here / 2);
    for (const std::uint32_t next : backwards ? map_.lanes_to(lane.from) : map_.lanes_from(lane.to))
      visit(here, 2 * next + here % 2);
    if (transfers) visit(here, here ^ 1U);
  }
  return seen;
}

// The largest set of states that lead to each other; where all can, that is the first. Of these, those that are driven:
// an AGV that has put its load down has come by a lane that it may not drive any more.
void DriveRules::keep_those_that_lead_back() {
  States judged(2 * map_.lane_count(), false);
  std::ptrdiff_t largest = -1;
  for (std::uint32_t state = 0; state < judged.size(); ++state) {
    if (judged[state]) continue;
    States both = connected(state, false, true);
    const States back = connected(state, true, true);
    for (std::size_t i = 0; i < both.size(); ++i) {
      both[i] = both[i] && back[i];
      judged[i] = judged[i] || both[i];
    }
    const auto size = std::ranges::count(both, 1);
    if (size <= largest) continue;
    largest = size;
    own_ = std::move(both);
    if (2 * largest >= static_cast<std::ptrdiff_t>(judged.size())) break;
  }
  for (const bool loaded : {false, true}) mark_those_that_lead_back(loaded);
  for (std::uint32_t state = 0; state < judged.size(); ++state) {
    if (!permits(state)) own_[state] = 0;
  }
}

// With this load, back to the part of the map through which most ways lead.
void DriveRules::mark_those_that_lead_back(bool loaded) {
  States judged(own_.size(), false), there;
  std::ptrdiff_t most = 0;
  // Not every state is tried on a large map; those from everywhere come first.
  const std::size_t lanes = own_.size() / 2, step = lanes / kMostTried + 1, in_a_row = lanes / step + 1;
  std::size_t tried = 0;
  for (std::size_t k = 0; k < step * in_a_row && tried < kMostTried; ++k) {
    const std::size_t lane = k / in_a_row + step * (k % in_a_row);
    const auto state = static_cast<std::uint32_t>(2 * lane + (loaded ? 1 : 0));
    if (lane >= lanes || own_[state] == 0 || judged[state]) continue;
    ++tried;
    const States ahead = connected(state, false, false);
    States behind = connected(state, true, false);
    for (std::size_t i = 0; i < judged.size(); ++i) judged[i] = judged[i] || (ahead[i] && behind[i]);
    const auto ways = std::ranges::count(ahead, 1) * std::ranges::count(behind, 1);
    if (ways <= most) continue;
    most = ways;
    there = std::move(behind);
  }
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (there[i]) own_[i] = kLeadsBack;
  }
}

}  // namespace fleetproof::agents
