#include "generators/worlds/fault_rates.hpp"

#include <fmt/format.h>

namespace fleetproof {

std::vector<FieldFault> rule_faults(const FaultRates& rates) {
  std::vector<FieldFault> faults;
  const auto in_order = [&](double least, double most, std::string_view least_key, std::string_view most_key) {
    if (most < least)
      faults.push_back({std::string(most_key), fmt::format("expected at least {}, which is {}", least_key, least)});
  };
  in_order(rates.protective_stop_least_s, rates.protective_stop_most_s, "protective_stop_least_s",
           "protective_stop_most_s");
  in_order(rates.freeze_least_s, rates.freeze_most_s, "freeze_least_s", "freeze_most_s");
  return faults;
}

}  // namespace fleetproof
