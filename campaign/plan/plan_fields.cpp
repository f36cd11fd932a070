#include "campaign/plan/plan_fields.hpp"

namespace fleetproof {
namespace {

constexpr double kSmallestBody_m = 1e-3, kLargestBody_m = 100.0, kHour_s = 3600.0, kDay_s = 86400.0;

}  // namespace

std::vector<NumberField> number_fields(VehicleType& v) {
  return {{"length_m", &v.footprint.length_m, kSmallestBody_m, kLargestBody_m},
          {"width_m", &v.footprint.width_m, kSmallestBody_m, kLargestBody_m},
          {"speed_mps", &v.drive.speed_mps, 0.01, 100.0},
          {"acceleration_mps2", &v.drive.acceleration_mps2, 0.01, 100.0},
          {"deceleration_mps2", &v.drive.deceleration_mps2, 0.01, 100.0},
          {"turn_speed_radps", &v.turn.speed_mps, 0.01, 100.0},
          {"turn_acceleration_radps2", &v.turn.acceleration_mps2, 0.01, 100.0},
          {"turn_deceleration_radps2", &v.turn.deceleration_mps2, 0.01, 100.0},
          {"loaded_extra_length_m", &v.loaded.extra_length_m, 0.0, kLargestBody_m},
          {"loaded_extra_width_m", &v.loaded.extra_width_m, 0.0, kLargestBody_m},
          {"loaded_speed_share", &v.loaded.speed_share, 0.1, 1.0},
          {"loaded_acceleration_share", &v.loaded.acceleration_share, 0.1, 1.0},
          {"lateral_mps2", &v.lateral_mps2, 0.0, 100.0},
          {"speed_deviation", &v.speed_deviation, 0.0, 0.5},
          {"settle_s", &v.settle_s, 0.0, kHour_s},
          {"battery_per_m", &v.battery_per_m, 0.0, 1.0},
          {"battery_idle_per_s", &v.battery_idle_per_s, 0.0, 1.0},
          {"charge_per_s", &v.charge_per_s, 1e-6, 1.0},
          {"pick_s", &v.pick_s, 0.0, kHour_s},
          {"drop_s", &v.drop_s, 0.0, kHour_s},
          {"storage_spread_s", &v.storage_spread_s, 0.0, kHour_s},
          {"other_spread_s", &v.other_spread_s, 0.0, kHour_s}};
}

std::vector<NumberField> number_fields(FaultRates& f) {
  constexpr double kMostPerHour = 3600.0;
  return {{"breakdowns_per_agv_hour", &f.breakdowns_per_agv_hour, 0.0, kMostPerHour},
          {"breakdowns_per_transport", &f.breakdowns_per_transport, 0.0, 1.0},
          {"repair_s", &f.repair_s, 0.0, kDay_s},
          {"protective_stops_per_agv_hour", &f.protective_stops_per_agv_hour, 0.0, kMostPerHour},
          {"protective_stop_least_s", &f.protective_stop_least_s, 0.0, kDay_s},
          {"protective_stop_most_s", &f.protective_stop_most_s, f.protective_stop_least_s, kDay_s},
          {"load_drops_per_transport", &f.load_drops_per_transport, 0.0, 1.0},
          {"load_lies_s", &f.load_lies_s, 0.0, kDay_s},
          {"obstacles_per_hour", &f.obstacles_per_hour, 0.0, kMostPerHour},
          {"obstacle_stays_s", &f.obstacle_stays_s, 0.0, kDay_s},
          {"restarts_per_agv_hour", &f.restarts_per_agv_hour, 0.0, kMostPerHour},
          {"restart_s", &f.restart_s, 0.0, kDay_s},
          {"freezes_per_agv_hour", &f.freezes_per_agv_hour, 0.0, kMostPerHour},
          {"freeze_least_s", &f.freeze_least_s, 0.0, kDay_s},
          {"freeze_most_s", &f.freeze_most_s, f.freeze_least_s, kDay_s},
          {"clock_offset_s", &f.clock_offset_s, 0.0, 1e6},
          {"clock_drift_ppm", &f.clock_drift_ppm, 0.0, 1e5},
          {"position_error_m", &f.position_error_m, 0.0, kLargestBody_m},
          {"position_late_s", &f.position_late_s, 0.0, kHour_s},
          {"low_battery_share", &f.low_battery_share, 0.0, 1.0}};
}

std::vector<NumberField> number_fields(ScannerSetup& s) {
  return {{"reaction_s", &s.reaction_s, 1e-3, 10.0},
          {"margin_m", &s.margin_m, 0.0, kLargestBody_m},
          {"resume_s", &s.resume_s, 0.0, kHour_s}};
}

std::vector<NumberField> number_fields(OperatorSetup& o) {
  return {{"least_s", &o.least_s, 1.0, kDay_s},
          {"most_s", &o.most_s, o.least_s, kDay_s},
          {"battery", &o.battery, 0.01, 1.0}};
}

std::vector<NumberField> number_fields(DrawnSources& s) {
  return {{"source_range_m", &s.like.range_m, 1e-3, 1e9},
          {"source_mean_on_s", &s.like.mean_on_s, 1e-3, 1e6},
          {"source_mean_off_s", &s.like.mean_off_s, 0.0, 1e6},
          {"source_loss", &s.like.loss, 0.0, 1.0}};
}

}  // namespace fleetproof
