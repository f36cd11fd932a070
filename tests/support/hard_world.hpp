#pragma once

#include "generators/world.hpp"

namespace fleetproof::test {

// A fleet of two types whose drives deviate, whose loads matter and whose batteries run low, among faults of everything but the floor: no load falls
// and nothing foreign stands about.
inline WorldSpec hard_world(double horizon_s) {
  WorldSpec spec;
  spec.horizon = seconds(horizon_s);
  spec.transports_per_agv_hour = 60.0;
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
  f.clock_offset_s = 1.0;
  f.clock_drift_ppm = 500.0;
  f.position_error_m = 0.05;
  f.position_late_s = 1.0;
  f.low_battery_share = 0.5;
  return spec;
}

}  // namespace fleetproof::test
