#include "core/agents/hull_parts.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof::agents {

bool HullParts::conflict(std::uint32_t a, std::uint32_t b) {
  const HullPart &of_a = tables_.part(a), &of_b = tables_.part(b);
  const double near_m = of_a.reach_m + of_b.reach_m + clearance_m();
  const Vec apart_m = of_a.centre_m - of_b.centre_m;
  if (dot(apart_m, apart_m) >= near_m * near_m) return false;
  // Of two turns or two lanes, the list of the first one is asked for; of a turn and a lane, that of the turn.
  const bool a_turns = is_turn(a), b_turns = is_turn(b);
  if (a_turns == b_turns ? b < a : b_turns) std::swap(a, b);
  return std::ranges::binary_search(remembered_conflicts_of(a), b);
}

// A few lists are needed all the time.
std::span<const std::uint32_t> HullParts::remembered_conflicts_of(std::uint32_t number) {
  if (remembered_.empty()) remembered_.resize(kRemembered);
  Remembered& place = remembered_[number % kRemembered];
  if (place.number != number) place = {number, conflicts_of(number)};
  return place.conflicts;
}

std::span<const std::uint32_t> HullParts::conflicts_of(std::uint32_t number) const {
  return ask<std::uint32_t>(
      facts_,
      [](const fp_facts* facts, std::uint64_t question, fp_answer* to) {
        const MapView map(*facts);
        answer(*facts, to, HullParts(map, *facts, HullKey(question)).find_conflicts(HullKey::item_of(question)));
      },
      key_.question(number));
}

std::uint32_t HullParts::whole_of(std::uint32_t number) const {
  if (!is_turn(number)) return number;
  const std::uint32_t first_turn = number - number % per_kind_ + map_.lane_count();
  return first_turn + tables_.turns().station_of(number - first_turn);
}

bool HullParts::shapes_conflict(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::any_of(tables_.shapes(a), [&](const Shape& of_a) {
    return std::ranges::any_of(tables_.shapes(b),
                               [&](const Shape& of_b) { return closer_than(of_a, of_b, clearance_m()); });
  });
}

// Of a turn, with all other parts; of a lane, with the lanes after it. The rectangles of a turn reach beyond the disc
// of any turn, which no corner leaves: two parts conflict only if each also conflicts with the whole of the other.
std::vector<std::uint32_t> HullParts::find_conflicts(std::uint32_t number) const {
  const bool turns = is_turn(number);
  const std::uint32_t whole = whole_of(number);
  const auto conflict_with = [&](std::uint32_t other) {
    if (!turns && (is_turn(other) || other < number)) return false;
    const std::uint32_t whole_other = whole_of(other);
    return (whole == number || shapes_conflict(whole, other)) &&
           (whole_other == other || shapes_conflict(number, whole_other)) && shapes_conflict(number, other);
  };
  std::vector<std::uint32_t> found = tables_.near().around(number);
  std::erase_if(found, [&](std::uint32_t other) { return !conflict_with(other); });
  return found;
}

std::span<const std::uint32_t> HullParts::lanes_blocked_by_turning(std::uint32_t station) const {
  return ask<std::uint32_t>(
      facts_,
      [](const fp_facts* facts, std::uint64_t question, fp_answer* to) {
        const MapView map(*facts);
        answer(*facts, to, HullParts(map, *facts, HullKey(question)).find_blocked_lanes(HullKey::item_of(question)));
      },
      key_.question(station));
}

std::vector<std::uint32_t> HullParts::find_blocked_lanes(std::uint32_t station) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t kind = 0; kind < tables_.kind_count(); ++kind) {
    for (const std::uint32_t other : conflicts_of(kind * per_kind_ + map_.lane_count() + station)) {
      if (!is_turn(other)) found.push_back(other % per_kind_);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool HullParts::standing_blocks_lane(std::uint32_t station, Vec heading, std::uint32_t lane) const {
  for (std::uint32_t standing = 0; standing < tables_.kind_count(); ++standing) {
    const Shape body = body_at(map_.position_m(station), heading, tables_.body(standing));
    for (std::uint32_t driving = 0; driving < tables_.kind_count(); ++driving) {
      if (conflicts_with_body(driving * per_kind_ + lane, body)) return true;
    }
  }
  return false;
}

bool HullParts::conflicts_with_body(std::uint32_t number, const Shape& body) const {
  const HullPart& part = tables_.part(number);
  const double far_m = part.reach_m + body.reach_m() + clearance_m();
  const Vec d = body.centre_m - part.centre_m;
  if (dot(d, d) >= far_m * far_m) return false;
  const auto near = [&](const Shape& shape) { return closer_than(shape, body, clearance_m()); };
  const std::uint32_t whole = whole_of(number);
  return std::ranges::any_of(tables_.shapes(number), near) &&
         (whole == number || std::ranges::any_of(tables_.shapes(whole), near));
}

}  // namespace fleetproof::agents
