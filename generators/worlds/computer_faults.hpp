#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scenario/fault_fields.hpp"
#include "generators/worlds/fault_rates.hpp"

// How often faults of a computer happen in the worlds of a campaign: the numbers, and what a campaign file says of
// them.
namespace fleetproof {

// A named fault (core/scenario/faults.hpp) that strikes now and then. Number and length are uniform.
struct NamedFaultRate {
  std::string word;
  double per_hour = 0.0;
  std::uint32_t number_least = 0, number_most = 0;
  double least_s = 0.0, most_s = 0.0;

  friend bool operator==(const NamedFaultRate&, const NamedFaultRate&) = default;
};

// By default, all rates are zero. Every kind is drawn from keys of its own, and each named fault by its place in the
// list.
struct ComputerFaultRates {
  double restarts_per_hour = 0.0, restart_s = 5.0;
  double power_failures_per_hour = 0.0, power_back_s = 60.0;
  double freezes_per_hour = 0.0, freeze_least_s = 0.2, freeze_most_s = 5.0;
  double disk_losses_per_hour = 0.0, disk_loss_s = 60.0;
  std::vector<NamedFaultRate> named;

  // The rates that AGVs have, too.
  FaultRates as_rates() const;
  friend bool operator==(const ComputerFaultRates&, const ComputerFaultRates&) = default;
};

inline constexpr std::size_t kMostNamedFaults = 64;  // of one computer

template <FieldsOf<NamedFaultRate> Rate, class Visit>
void visit_fields(Rate& rate, Visit&& visit) {
  auto& [word, per_hour, number_least, number_most, least_s, most_s] = rate;
  const auto number = [](std::string_view key, std::string_view text) {
    return Field{
        .key = key, .text = text, .lenient = Lenient::none("its program alone knows it"), .high = 4294967295.0};
  };
  // While it lasts, the fleet is not accused of standing still.
  const auto time = [](std::string_view key, std::string_view text) {
    return Field{.key = key, .text = text, .lenient = Lenient::up(Weight::Load), .high = kDay_s};
  };
  visit(Field{.key = "word", .text = "what its program calls the fault", .lenient = kIsName, .needed = true}, word);
  visit(Field{.key = "per_hour", .text = "it strikes so often", .lenient = Lenient::down(Weight::Load), .high = 3600.0},
        per_hour);
  visit(number("number_least", "smallest number that the program is told with it"), number_least);
  visit(number("number_most", "largest number; uniform"), number_most);
  visit(time("least_s", "shortest length that the program is told"), least_s);
  visit(time("most_s", "longest length; uniform"), most_s);
}

template <FieldsOf<ComputerFaultRates> Rates, class Visit>
void visit_fields(Rates& rates, Visit&& visit) {
  auto& [restarts_per_hour, restart_s, power_failures_per_hour, power_back_s, freezes_per_hour, freeze_least_s,
         freeze_most_s, disk_losses_per_hour, disk_loss_s, named] = rates;
  const auto rate = [](std::string_view key, std::string_view text) {
    return Field{.key = key, .text = text, .lenient = Lenient::down(Weight::Load), .high = 3600.0};
  };
  const auto time = [](std::string_view key, Lenient lenient, std::string_view text) {
    return Field{.key = key, .text = text, .lenient = lenient, .high = kDay_s};
  };
  visit(rate("restarts_per_hour", "its program loses its memory and starts again"), restarts_per_hour);
  visit(time("restart_s", Lenient::either(Weight::Load), "for so long it is away"), restart_s);
  visit(rate("power_failures_per_hour", "as a restart, for a drawn time"), power_failures_per_hour);
  visit(time("power_back_s", Lenient::up(Weight::Load), "mean time until the power is back; exponential"),
        power_back_s);
  visit(rate("freezes_per_hour", "its program does not answer, and then sees everything at once"), freezes_per_hour);
  visit(time("freeze_least_s", Lenient::down(Weight::Load), "shortest freeze"), freeze_least_s);
  visit(time("freeze_most_s", Lenient::down(Weight::Load), "longest freeze; uniform"), freeze_most_s);
  visit(rate("disk_losses_per_hour", "its program starts again and finds nothing that it has kept"),
        disk_losses_per_hour);
  visit(time("disk_loss_s", Lenient::either(Weight::Load), "for so long it is away then"), disk_loss_s);
  visit(Field{.key = "named",
              .text = "faults that its program alone understands; several tables",
              .lenient = kIsTable,
              .left_out = named.empty()},
        named);
}

// Rules between two of the fields.
std::vector<FieldFault> rule_faults(const NamedFaultRate& rate);
std::vector<FieldFault> rule_faults(const ComputerFaultRates& rates);

}  // namespace fleetproof
