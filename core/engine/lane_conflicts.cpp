#include "core/engine/lane_conflicts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr double kLargestMargin_m = 100.0;
constexpr double kNoTurn_rad = 1e-7;     // as fleetproof/agent.h has it
constexpr double kHeadingLength = 1e-6;  // so far from 1 may the length of a heading be
constexpr std::size_t kMostAnswers = 1'000'000, kMostSweeps = 100'000;

// By fp_load_state.
std::array<Footprint, 3> footprints_of(const VehicleType& type) {
  const Footprint empty = type.footprint_with(false), loaded = type.footprint_with(true);
  const Footprint any{std::max(empty.length_m, loaded.length_m), std::max(empty.width_m, loaded.width_m),
                      empty.centre_ahead_m};
  return {any, empty, loaded};
}

std::vector<std::array<Footprint, 3>> all_footprints(const Scenario& scenario) {
  std::vector<std::array<Footprint, 3>> all;
  all.reserve(scenario.vehicle_types.size());
  for (const VehicleType& type : scenario.vehicle_types) all.push_back(footprints_of(type));
  return all;
}

bool has_heading(const fp_occupancy& occupancy) { return occupancy.heading_x != 0.0 || occupancy.heading_y != 0.0; }

// +0 and -0 are one heading.
std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }

}  // namespace

LaneConflicts::LaneConflicts(const Scenario& scenario)
    : map_(scenario.map), footprints_(all_footprints(scenario)), safety_distance_m_(scenario.law.safety_distance_m) {}

bool LaneConflicts::fits(const Scenario& scenario) const {
  return map_ == scenario.map && safety_distance_m_ == scenario.law.safety_distance_m &&
         footprints_ == all_footprints(scenario);
}

std::optional<bool> LaneConflicts::answer(const fp_occupancy& a, const fp_occupancy& b, double margin_m) {
  const auto first = key_of(a), second = key_of(b);
  if (!first || !second || !(margin_m >= 0.0 && margin_m <= kLargestMargin_m)) return std::nullopt;
  if (margin_m != margin_m_ || answers_.size() >= kMostAnswers) answers_.clear();
  margin_m_ = margin_m;
  const std::array pair{std::min(*first, *second), std::max(*first, *second)};
  if (const auto known = answers_.find(pair); known != answers_.end()) return known->second;
  if (sweeps_.size() >= kMostSweeps) sweeps_.clear();
  const Sweep& one = sweep_of(*first, a);
  const bool found = may_come_closer(one, sweep_of(*second, b), safety_distance_m_ + margin_m);
  answers_.emplace(pair, found);
  return found;
}

std::optional<LaneConflicts::Key> LaneConflicts::key_of(const fp_occupancy& occupancy) const {
  const bool stands = occupancy.lane == FP_NONE;
  const double length = Vec2(occupancy.heading_x, occupancy.heading_y).norm();
  const bool is_wrong =
      occupancy.struct_size < sizeof(fp_occupancy) || occupancy.vehicle_type >= footprints_.size() ||
      occupancy.load > FP_LOADED_ONLY ||
      (stands ? occupancy.station >= map_->station_count() : occupancy.lane >= map_->lanes().size()) ||
      (has_heading(occupancy) && !(std::abs(length - 1.0) <= kHeadingLength)) || std::isnan(length);
  if (is_wrong) return std::nullopt;
  const std::uint64_t vehicle = std::uint64_t{occupancy.vehicle_type} << 2 | occupancy.load;
  const std::uint64_t place = stands ? std::uint64_t{1} << 32 | occupancy.station : occupancy.lane;
  return Key{place, vehicle, bits_of(occupancy.heading_x), bits_of(occupancy.heading_y)};
}

const Sweep& LaneConflicts::sweep_of(const Key& key, const fp_occupancy& occupancy) {
  const auto known = sweeps_.find(key);
  return known != sweeps_.end() ? known->second : sweeps_.emplace(key, make_sweep(occupancy)).first->second;
}

Sweep LaneConflicts::make_sweep(const fp_occupancy& occupancy) const {
  Sweep sweep(footprints_[occupancy.vehicle_type][occupancy.load]);
  const Vec2 given =
      has_heading(occupancy) ? Vec2(occupancy.heading_x, occupancy.heading_y).normalized() : Vec2::UnitX();
  if (occupancy.lane == FP_NONE) {
    const Vec2& at_m = map_->station(StationId{occupancy.station}).position_m;
    sweep.add_turn({at_m, given}, has_heading(occupancy) ? 0.0 : 2.0 * kPi);
    return sweep;
  }
  const Lane& lane = map_->lanes()[occupancy.lane];
  const Vec2& at_m = map_->station(lane.from).position_m;
  const double turn_rad = angle_between(given, lane.start_heading());
  const bool is_half = kPi - std::abs(turn_rad) <= kNoTurn_rad;  // it may go either way
  if (!has_heading(occupancy) || is_half) {
    sweep.add_turn({at_m, given}, 2.0 * kPi);
  } else if (std::abs(turn_rad) > kNoTurn_rad) {
    sweep.add_turn({at_m, given}, turn_rad);
  }
  sweep.add_drive(lane.curve);
  return sweep;
}

}  // namespace fleetproof
