#include "core/agents/hull_parts.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof::agents {

bool HullParts::conflict(std::uint32_t a, std::uint32_t b) {
  const HullPart &of_a = part(a), &of_b = part(b);
  const double near_m = of_a.reach_m + of_b.reach_m + clearance_m();
  const Vec apart_m = of_a.centre_m - of_b.centre_m;
  if (dot(apart_m, apart_m) >= near_m * near_m) return false;
  // The list of the part with the higher rank is asked for; of equal ranks, that of the first one.
  const Rank rank_a = numbers_.rank(a), rank_b = numbers_.rank(b);
  if (rank_a == rank_b ? b < a : rank_a < rank_b) std::swap(a, b);
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

std::uint32_t HullParts::of_turn(std::uint32_t agv, std::uint32_t station, Vec from, Vec to) const {
  const std::uint32_t sector = tables_.sectors().find(station, from, to);
  return sector == FP_NONE ? of_turn(agv, station) : numbers_.of_sector(tables_.kind_of(agv), sector);
}

std::vector<Shape> HullParts::shapes_of_sector(std::uint32_t number) const {
  const Sector& sector = tables_.sectors()[numbers_.sector(number)];
  const Body body = turning_body(tables_.body(numbers_.kind(number)), key_.options);
  std::vector<Shape> shapes;
  shapes.reserve(kMostTurnPieces);
  append_turn(map_.position_m(sector.station), sector.from, sector.to, body, shapes);
  return shapes;
}

bool HullParts::come_close(std::span<const Shape> a, std::span<const Shape> b) const {
  return std::ranges::any_of(a, [&](const Shape& of_a) {
    return std::ranges::any_of(b, [&](const Shape& of_b) { return closer_than(of_a, of_b, clearance_m()); });
  });
}

// Of a disc, with lanes and other discs; of a lane, with the lanes after it.
std::vector<std::uint32_t> HullParts::find_conflicts(std::uint32_t number) const {
  const Rank rank = numbers_.rank(number);
  if (rank == Rank::Sector) return find_conflicts_of_sector(number);
  std::vector<std::uint32_t> found = tables_.near().around(number);
  std::erase_if(found, [&](std::uint32_t other) {
    if (rank == Rank::Lane && (other < number || numbers_.rank(other) == Rank::Disc)) return true;
    return !come_close(tables_.shapes(number), tables_.shapes(other));
  });
  return found;
}

// With all other parts. The rectangles of a sector reach a little beyond its disc, which no corner of the body leaves.
// What the body covers lies in both, so two sectors conflict only if rectangles and disc of one are close to both of
// the other.
std::vector<std::uint32_t> HullParts::find_conflicts_of_sector(std::uint32_t number) const {
  const auto disc = tables_.shapes(whole_of(number));
  const std::vector<Shape> shapes = shapes_of_sector(number);
  std::vector<std::uint32_t> found;
  for (const std::uint32_t other : tables_.near().around(whole_of(number))) {
    const auto whole = tables_.shapes(other);
    if (!come_close(disc, whole) || !come_close(shapes, whole)) continue;
    found.push_back(other);
    if (numbers_.rank(other) != Rank::Disc) continue;
    const std::uint32_t station = numbers_.station(other), end = tables_.sectors().begin_at(station + 1);
    for (std::uint32_t i = tables_.sectors().begin_at(station); i < end; ++i) {
      const std::uint32_t sector = numbers_.of_sector(numbers_.kind(other), i);
      const std::vector<Shape> others = shapes_of_sector(sector);
      if (come_close(disc, others) && come_close(shapes, others)) found.push_back(sector);
    }
  }
  std::ranges::sort(found);
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
    for (const std::uint32_t other : conflicts_of(numbers_.of_disc(kind, station))) {
      if (numbers_.rank(other) == Rank::Lane) found.push_back(numbers_.lane(other));
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
      if (conflicts_with_body(numbers_.of_lane(driving, lane), body)) return true;
    }
  }
  return false;
}

bool HullParts::conflicts_with_body(std::uint32_t number, const Shape& body) const {
  const HullPart& whole = part(number);
  const double far_m = whole.reach_m + body.reach_m() + clearance_m();
  const Vec d = body.centre_m - whole.centre_m;
  if (dot(d, d) >= far_m * far_m || !come_close(tables_.shapes(whole_of(number)), {&body, 1})) return false;
  return !numbers_.is_sector(number) || come_close(shapes_of_sector(number), {&body, 1});
}

}  // namespace fleetproof::agents
