#pragma once

#include <algorithm>
#include <string>

#include "core/geometry/rectangle.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// What a load changes: the body grows equally on both sides, and driving becomes slower.
struct LoadEffect {
  double extra_length_m = 0.0, extra_width_m = 0.0;
  double speed_share = 1.0;         // share of the empty vehicle's speed
  double acceleration_share = 1.0;  // share of its acceleration and deceleration

  friend bool operator==(const LoadEffect&, const LoadEffect&) = default;
};

// A kind of AGV.
struct VehicleType {
  std::string name = "pallet-agv";
  Footprint footprint;
  MotionLimits drive;
  TurnLimits turn;
  LoadEffect loaded;
  double lateral_mps2 = 0.0;       // the speed in a bend of radius R is at most sqrt(lateral_mps2 * R); 0: no limit
  double reverse_speed_mps = 0.0;  // top speed of driving backward, lower or higher than forward; 0: as forward
  double speed_deviation = 0.0;    // every drive is faster or slower by up to this share, in speed and acceleration
  double settle_s = 0.0;           // fine positioning after every drive to a stop: uniform on [0, settle_s)
  double battery_per_m = 1.0 / 20000.0;  // share of a full battery
  double battery_idle_per_s = 0.0;       // share that the AGV uses unless it charges
  double charge_per_s = 1.0 / 3600.0;
  double dock_s = 0.0;                // connecting to the charger, before charging begins
  double pick_s = 5.0, drop_s = 5.0;  // the shortest time of a transfer
  double storage_spread_s = 0.0;      // how much longer a transfer may take at a storage station, uniform
  double other_spread_s = 0.0;        // how much longer a transfer may take at any other station, uniform

  Footprint footprint_with(bool load) const {
    return load ? Footprint{footprint.length_m + loaded.extra_length_m, footprint.width_m + loaded.extra_width_m,
                            footprint.centre_ahead_m}
                : footprint;
  }
  // How fast a drive may be, and how fast it speeds up and brakes. A load slows both directions by the same share.
  MotionLimits drive_with(bool load, bool backward) const {
    MotionLimits limits = drive;
    if (backward && reverse_speed_mps > 0.0) limits.speed_mps = reverse_speed_mps;
    if (!load) return limits;
    return {limits.speed_mps * loaded.speed_share, limits.acceleration_mps2 * loaded.acceleration_share,
            limits.deceleration_mps2 * loaded.acceleration_share};
  }
  double highest_speed_mps() const { return std::max(drive.speed_mps, reverse_speed_mps); }
};

}  // namespace fleetproof
