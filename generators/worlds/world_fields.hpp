#pragma once

#include <vector>

#include "core/scenario/scenario_fields.hpp"
#include "generators/worlds/drawn_faults.hpp"
#include "generators/worlds/drawn_radio.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_maker.hpp"

// The fields of what a campaign fixes about its worlds.
namespace fleetproof {

inline constexpr Field kClocksAgree{
    .key = "clocks_agree_share",
    .text = "chance that the clocks of a world agree: no offset, no drift; AGVs then begin at one instant"};
inline constexpr Field kPlacement{.key = "placement", .text = "how the fleet stands at the start"};

template <FieldsOf<Demand> Given, class Visit>
void visit_fields(Given& demand, Visit&& visit) {
  auto& [transports_per_agv_hour, hot_spot_skew] = demand;
  visit(Field{.key = "transports_per_agv_hour",
              .text = "mean of a Poisson process for each AGV, whose first order comes within 10 s; 0: no orders",
              .high = 3600.0},
        transports_per_agv_hour);
  visit(Field{.key = "hot_spot_skew",
              .text = "the n-th busiest station gets n^-skew of the busiest one's orders; 0: all get alike",
              .high = 4.0},
        hot_spot_skew);
}

template <FieldsOf<FaultRates> Rates, class Visit>
void visit_fields(Rates& rates, Visit&& visit) {
  auto& [breakdowns_per_agv_hour, breakdowns_per_transport, repair_s, protective_stops_per_agv_hour,
         protective_stop_least_s, protective_stop_most_s, load_drops_per_transport, load_lies_s, obstacles_per_hour,
         obstacle_stays_s, restarts_per_agv_hour, restart_s, freezes_per_agv_hour, freeze_least_s, freeze_most_s,
         power_failures_per_agv_hour, power_back_s, clock_offset_s, clock_drift_ppm, clocks_agree_share,
         position_error_m, position_late_s, low_battery_share] = rates;
  const auto rate = [](std::string_view key, std::string_view text) {
    return Field{.key = key, .text = text, .high = 3600.0};
  };
  const auto time = [](std::string_view key, std::string_view text) {
    return Field{.key = key, .text = text, .high = kDay_s};
  };
  visit(rate("breakdowns_per_agv_hour", "an AGV breaks down and blocks its place; 1 / MTBF"), breakdowns_per_agv_hour);
  visit(Field{.key = "breakdowns_per_transport", .text = "chance of a breakdown on the way with a load"},
        breakdowns_per_transport);
  visit(time("repair_s", "mean time until it goes on (MTTR); exponential"), repair_s);
  visit(rate("protective_stops_per_agv_hour", "an AGV stops in mid-segment and goes on by itself; 1 to 20 are usual"),
        protective_stops_per_agv_hour);
  visit(time("protective_stop_least_s", "shortest protective stop"), protective_stop_least_s);
  visit(time("protective_stop_most_s", "longest protective stop; uniform"), protective_stop_most_s);
  visit(Field{.key = "load_drops_per_transport", .text = "chance that a load of 1.2 m x 0.8 m falls behind the AGV"},
        load_drops_per_transport);
  visit(time("load_lies_s", "mean time until it is cleared away; exponential"), load_lies_s);
  visit(rate("obstacles_per_hour", "a body of 0.8 m x 0.6 m appears on or beside a lane; in the whole warehouse"),
        obstacles_per_hour);
  visit(time("obstacle_stays_s", "mean time until it leaves; exponential"), obstacle_stays_s);
  visit(rate("restarts_per_agv_hour", "an agent loses its memory and starts again"), restarts_per_agv_hour);
  visit(time("restart_s", "for so long it is away"), restart_s);
  visit(rate("freezes_per_agv_hour", "an agent does not answer, and then sees everything at once"),
        freezes_per_agv_hour);
  visit(time("freeze_least_s", "shortest freeze"), freeze_least_s);
  visit(time("freeze_most_s", "longest freeze; uniform"), freeze_most_s);
  visit(rate("power_failures_per_agv_hour", "an AGV stops where it is and its agent loses its memory"),
        power_failures_per_agv_hour);
  visit(time("power_back_s", "mean time until the power is back; exponential"), power_back_s);
  visit(Field{.key = "clock_offset_s", .text = "each AGV's clock is ahead by up to this; uniform", .high = 1e6},
        clock_offset_s);
  visit(Field{.key = "clock_drift_ppm", .text = "each AGV's clock is too fast or too slow by up to this", .high = 1e5},
        clock_drift_ppm);
  visit(kClocksAgree.left_out_if(clocks_agree_share == 0.0), clocks_agree_share);
  visit(Field{.key = "position_error_m",
              .text = "each coordinate of getPosition is wrong by up to this",
              .high = kLargestBody_m},
        position_error_m);
  visit(Field{.key = "position_late_s", .text = "getPosition tells where the AGV was so long ago", .high = kHour_s},
        position_late_s);
  visit(Field{.key = "low_battery_share", .text = "chance that an AGV starts with 12 to 20 % of its battery"},
        low_battery_share);
}

// Sources are alike in all but their places, which are drawn.
template <FieldsOf<DrawnSources> Sources, class Visit>
void visit_fields(Sources& sources, Visit&& visit) {
  auto& [count, like] = sources;
  visit(Field{.key = "sources",
              .text = "external sources (other networks, ovens, welding robots), in other places in every replicate",
              .high = 1000.0},
        count);
  visit_fields(like, [&](const Field& field, auto& value) {
    if (field.key == "range_m") visit(field.named("source_range_m"), value);
    if (field.key == "mean_on_s") visit(field.named("source_mean_on_s"), value);
    if (field.key == "mean_off_s") visit(field.named("source_mean_off_s"), value);
    if (field.key == "loss") visit(field.named("source_loss"), value);
  });
}

template <FieldsOf<VehicleShare> Share, class Visit>
void visit_fields(Share& vehicle, Visit&& visit) {
  auto& [type, share] = vehicle;
  visit(Field{.key = "share",
              .text = "how much of the fleet is of this type, relative to the others",
              .high = 1e6,
              .above_low = true},
        share);
  visit_fields(type, visit);
}

// Rules between two of the rates.
std::vector<FieldFault> rule_faults(const FaultRates& rates);

}  // namespace fleetproof
