#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scenario/fault_fields.hpp"

// How often faults happen in the worlds of a campaign: the numbers, and what a campaign file says of them.
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
  double disk_losses_per_agv_hour = 0.0;
  double disk_loss_s = 60.0;  // the agent is away

  friend bool operator==(const FaultRates&, const FaultRates&) = default;
};

// What is drawn; with the number of an AGV, these key every sequence of draws of the faults stream. Append only.
enum class FaultTopic : std::uint32_t {
  Breakdown = 1,
  MissionBreakdown = 2,
  ProtectiveStop = 3,
  LoadDrop = 4,
  Obstacle = 5,
  Restart = 6,
  Freeze = 7,
  Clock = 8,
  Battery = 9,
  PowerFailure = 10,
  ClocksAgree = 11,
  DiskLoss = 12,
  Named = 1000,  // and those behind it: one for each place in the list of a computer
};

// A kind of fault that strikes each AGV now and then, as a Poisson process, and how long it lasts: exponentially with
// the mean `lasts_s`, uniformly from `lasts_s` to `most_s`, or exactly `lasts_s`.
struct RecurringFault {
  enum class Lasting : std::uint8_t { Exponential, Uniform, Exact };
  Fault::Kind kind;
  FaultTopic topic;
  double FaultRates::*per_agv_hour;
  Lasting lasting;
  double FaultRates::*lasts_s;
  double FaultRates::*most_s = nullptr;
};
// The faults of an AGV stand in a scenario in this order.
inline constexpr auto kRecurringFaults = std::to_array<RecurringFault>({
    {Fault::Kind::Breakdown, FaultTopic::Breakdown, &FaultRates::breakdowns_per_agv_hour,
     RecurringFault::Lasting::Exponential, &FaultRates::repair_s},
    {Fault::Kind::ProtectiveStop, FaultTopic::ProtectiveStop, &FaultRates::protective_stops_per_agv_hour,
     RecurringFault::Lasting::Uniform, &FaultRates::protective_stop_least_s, &FaultRates::protective_stop_most_s},
    {Fault::Kind::Restart, FaultTopic::Restart, &FaultRates::restarts_per_agv_hour, RecurringFault::Lasting::Exact,
     &FaultRates::restart_s},
    {Fault::Kind::Freeze, FaultTopic::Freeze, &FaultRates::freezes_per_agv_hour, RecurringFault::Lasting::Uniform,
     &FaultRates::freeze_least_s, &FaultRates::freeze_most_s},
    {Fault::Kind::PowerFailure, FaultTopic::PowerFailure, &FaultRates::power_failures_per_agv_hour,
     RecurringFault::Lasting::Exponential, &FaultRates::power_back_s},
    {Fault::Kind::DiskLoss, FaultTopic::DiskLoss, &FaultRates::disk_losses_per_agv_hour, RecurringFault::Lasting::Exact,
     &FaultRates::disk_loss_s},
});

inline constexpr Field kClocksAgree{
    .key = "clocks_agree_share",
    .text = "chance that the clocks of a world agree: no offset, no drift; AGVs then begin at one instant",
    .lenient = Lenient::up(Weight::Load)};

inline constexpr Field kLowBatteries{.key = "low_battery_share",
                                     .text = "chance that an AGV starts with 12 to 20 % of its battery",
                                     .lenient = Lenient::down(Weight::Load)};
inline constexpr Field kDiskLosses{.key = "disk_losses_per_agv_hour",
                                   .text = "an agent starts again and finds nothing that it has kept",
                                   .lenient = Lenient::down(Weight::Load),
                                   .high = 3600.0};
inline constexpr Field kDiskLossLasts{.key = "disk_loss_s",
                                      .text = "for so long it is away then",
                                      .lenient = Lenient::either(Weight::Load),
                                      .high = kDay_s};

template <FieldsOf<FaultRates> Rates, class Visit>
void visit_fields(Rates& rates, Visit&& visit) {
  auto& [breakdowns_per_agv_hour, breakdowns_per_transport, repair_s, protective_stops_per_agv_hour,
         protective_stop_least_s, protective_stop_most_s, load_drops_per_transport, load_lies_s, obstacles_per_hour,
         obstacle_stays_s, restarts_per_agv_hour, restart_s, freezes_per_agv_hour, freeze_least_s, freeze_most_s,
         power_failures_per_agv_hour, power_back_s, clock_offset_s, clock_drift_ppm, clocks_agree_share,
         position_error_m, position_late_s, low_battery_share, disk_losses_per_agv_hour, disk_loss_s] = rates;
  const auto rate = [](std::string_view key, std::string_view text) {
    return Field{.key = key, .text = text, .lenient = Lenient::down(Weight::Load), .high = 3600.0};
  };
  const auto time = [](std::string_view key, Lenient lenient, std::string_view text) {
    return Field{.key = key, .text = text, .lenient = lenient, .high = kDay_s};
  };
  visit(rate("breakdowns_per_agv_hour", "an AGV breaks down and blocks its place; 1 / MTBF"), breakdowns_per_agv_hour);
  visit(Field{.key = "breakdowns_per_transport",
              .text = "chance of a breakdown on the way with a load",
              .lenient = Lenient::down(Weight::Load)},
        breakdowns_per_transport);
  visit(time("repair_s", Lenient::up(Weight::Load), "mean time until it goes on (MTTR); exponential"), repair_s);
  visit(rate("protective_stops_per_agv_hour", "an AGV stops in mid-segment and goes on by itself; 1 to 20 are usual"),
        protective_stops_per_agv_hour);
  visit(time("protective_stop_least_s", Lenient::up(Weight::Load), "shortest protective stop"),
        protective_stop_least_s);
  visit(time("protective_stop_most_s", Lenient::up(Weight::Load), "longest protective stop; uniform"),
        protective_stop_most_s);
  visit(Field{.key = "load_drops_per_transport",
              .text = "chance that a load of 1.2 m x 0.8 m falls behind the AGV",
              .lenient = Lenient::down(Weight::Load)},
        load_drops_per_transport);
  visit(time("load_lies_s", Lenient::up(Weight::Load), "mean time until it is cleared away; exponential"), load_lies_s);
  visit(rate("obstacles_per_hour", "a body of 0.8 m x 0.6 m appears on or beside a lane; in the whole warehouse"),
        obstacles_per_hour);
  visit(time("obstacle_stays_s", Lenient::up(Weight::Load), "mean time until it leaves; exponential"),
        obstacle_stays_s);
  visit(rate("restarts_per_agv_hour", "an agent loses its memory and starts again"), restarts_per_agv_hour);
  visit(time("restart_s", Lenient::either(Weight::Load), "for so long it is away"), restart_s);
  visit(rate("freezes_per_agv_hour", "an agent does not answer, and then sees everything at once"),
        freezes_per_agv_hour);
  visit(time("freeze_least_s", Lenient::down(Weight::Load), "shortest freeze"), freeze_least_s);
  visit(time("freeze_most_s", Lenient::down(Weight::Load), "longest freeze; uniform"), freeze_most_s);
  visit(rate("power_failures_per_agv_hour", "an AGV stops where it is and its agent loses its memory"),
        power_failures_per_agv_hour);
  visit(time("power_back_s", Lenient::up(Weight::Load), "mean time until the power is back; exponential"),
        power_back_s);
  visit(Field{.key = "clock_offset_s",
              .text = "each AGV's clock is ahead by up to this; uniform",
              .lenient = Lenient::down(Weight::Load),
              .high = 1e6},
        clock_offset_s);
  visit(Field{.key = "clock_drift_ppm",
              .text = "each AGV's clock is too fast or too slow by up to this",
              .lenient = Lenient::down(Weight::Load),
              .high = 1e5},
        clock_drift_ppm);
  visit(kClocksAgree.left_out_if(clocks_agree_share == 0.0), clocks_agree_share);
  visit(Field{.key = "position_error_m",
              .text = "each coordinate of getPosition is wrong by up to this",
              .lenient = Lenient::down(Weight::Load),
              .high = kLargestBody_m},
        position_error_m);
  visit(Field{.key = "position_late_s",
              .text = "getPosition tells where the AGV was so long ago",
              .lenient = Lenient::down(Weight::Load),
              .high = kHour_s},
        position_late_s);
  visit(kLowBatteries, low_battery_share);
  visit(kDiskLosses.left_out_if(disk_losses_per_agv_hour == 0.0), disk_losses_per_agv_hour);
  visit(kDiskLossLasts.left_out_if(disk_loss_s == 60.0), disk_loss_s);
}

// Rules between two of the rates.
std::vector<FieldFault> rule_faults(const FaultRates& rates);

}  // namespace fleetproof
