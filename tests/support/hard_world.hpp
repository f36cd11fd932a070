#pragma once

#include "generators/families/layout_family.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::test {

// A bow, or an S of two Beziers, instead of every straight segment but one in four: up to a fifth of its length off the
// straight line.
inline void bend(Segment& segment, const Vec2& from_m, const Vec2& to_m, Draws& draws) {
  if (!segment.control_points_m.empty() || draws.below(4) == 0) return;
  const Vec2 way_m = to_m - from_m, left_m(-way_m.y(), way_m.x());
  const auto beside = [&](double along) { return Vec2(from_m + along * way_m + draws.uniform(-0.2, 0.2) * left_m); };
  if (draws.below(2) == 0) {
    segment.control_points_m = {beside(0.3), beside(0.7)};
  } else {
    segment.control_points_m = {beside(0.2), beside(0.4), beside(0.5), beside(0.6), beside(0.8)};
    smooth_joints(segment);
  }
}

// A layout of a family with bent lanes. Straight lanes would hide errors of curves, of hulls in bends, and of speeds in
// bends.
inline std::shared_ptr<const LogicalMap> bent_map(FamilyRange choice, std::uint64_t seed) {
  Draws draws(stream_key(seed, Stream::Layout));
  while (true) {
    Layout layout = draw_layout(choice, draws);
    layout.name += ", bent";
    for (Segment& segment : layout.segments) {
      bend(segment, layout.stations[segment.from.index()].position_m, layout.stations[segment.to.index()].position_m,
           draws);
    }
    fit_floor(layout, 3.0);
    if (problems_of(layout).empty()) return std::make_shared<const LogicalMap>(layout);
  }
}

// A fleet of two types with drive deviations, large loads and low batteries, among faults of all kinds except those on
// the floor: no load falls, and there are no foreign obstacles.
inline WorldSpec hard_world(double horizon_s) {
  WorldSpec spec;
  spec.horizon = seconds(horizon_s);
  spec.demand.transports_per_agv_hour = 60.0;
  VehicleType& type = spec.vehicles[0].type;
  type.loaded = {.extra_length_m = 0.1, .extra_width_m = 0.1, .speed_share = 0.8, .acceleration_share = 0.9};
  type.lateral_mps2 = 0.4;
  type.speed_deviation = 0.05;
  type.settle_s = 0.5;
  type.battery_per_m = 0.002;
  type.battery_idle_per_s = 0.0005;
  type.storage_spread_s = 10.0;
  VehicleType slow = type;
  slow.name = "slow";
  slow.drive.speed_mps = 1.0;
  spec.vehicles.push_back({slow, 0.5});
  FaultRates& f = spec.faults;
  f.breakdowns_per_agv_hour = 20.0;
  f.breakdowns_per_transport = 0.2;
  f.repair_s = 10.0;
  f.protective_stops_per_agv_hour = 60.0;
  f.restarts_per_agv_hour = 40.0;
  f.freezes_per_agv_hour = 60.0;
  f.power_failures_per_agv_hour = 20.0;
  f.power_back_s = 20.0;
  f.disk_losses_per_agv_hour = 2.0;
  f.disk_loss_s = 5.0;
  for (const RecurringFault& fault : kRecurringFaults) {
    if (f.*fault.per_agv_hour == 0.0) f.*fault.per_agv_hour = 20.0;  // a kind that nobody has added here
  }
  f.clock_offset_s = 1.0;
  f.clock_drift_ppm = 500.0;
  f.position_error_m = 0.05;
  f.position_late_s = 1.0;
  f.low_battery_share = 0.5;
  return spec;
}

}  // namespace fleetproof::test
