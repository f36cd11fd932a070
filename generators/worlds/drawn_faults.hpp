#pragma once

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// How often faults happen, and how severe they are. By default, all rates are zero. Every kind is drawn from keys of
// its own: switching on one kind does not change the others.
struct FaultRates {
  double breakdowns_per_agv_hour = 0.0;   // 1 / MTBF
  double breakdowns_per_transport = 0.0;  // probability of a breakdown on the way with a load
  double repair_s = 900.0;                // MTTR, exponential
  double protective_stops_per_agv_hour = 0.0;
  double protective_stop_least_s = 2.0, protective_stop_most_s = 10.0;
  double load_drops_per_transport = 0.0;
  double load_lies_s = 300.0;       // mean, exponential
  double obstacles_per_hour = 0.0;  // foreign bodies on or beside a lane
  double obstacle_stays_s = 120.0;  // mean, exponential
  double restarts_per_agv_hour = 0.0;
  double restart_s = 5.0;  // the agent is away
  double freezes_per_agv_hour = 0.0;
  double freeze_least_s = 0.2, freeze_most_s = 5.0;
  double power_failures_per_agv_hour = 0.0;
  double power_back_s = 60.0;       // mean, exponential
  double clock_offset_s = 0.0;      // each AGV's clock is ahead by up to this
  double clock_drift_ppm = 0.0;     // each AGV's clock is too fast or too slow by up to this
  double clocks_agree_share = 0.0;  // probability that the clocks of a world have no offset and no drift
  double position_error_m = 0.0;    // as in SensingSetup, for every AGV
  double position_late_s = 0.0;
  double low_battery_share = 0.0;  // probability that an AGV starts with 12 to 20 %

  friend bool operator==(const FaultRates&, const FaultRates&) = default;
};

// Draws the faults of a scenario whose fleet and transports are final. A pure function of scenario, rates and `key`.
void draw_faults(Scenario& scenario, const FaultRates& rates, std::uint64_t key);

}  // namespace fleetproof
