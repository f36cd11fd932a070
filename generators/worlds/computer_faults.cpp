#include "generators/worlds/computer_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/base/outside_text.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

template <class Number>
void demand_order(std::vector<FieldFault>& faults, Number least, Number most, std::string_view least_key,
                  std::string_view most_key) {
  if (most < least)
    faults.push_back({std::string(most_key), fmt::format("expected at least {}, which is {}", least_key, least)});
}

}  // namespace

std::vector<FieldFault> rule_faults(const NamedFaultRate& rate) {
  std::vector<FieldFault> faults;
  if (const char* why_not = fault_of_name(rate.word)) faults.push_back({"word", why_not});
  demand_order(faults, rate.number_least, rate.number_most, "number_least", "number_most");
  demand_order(faults, rate.least_s, rate.most_s, "least_s", "most_s");
  return faults;
}

std::vector<FieldFault> rule_faults(const ComputerFaultRates& rates) {
  std::vector<FieldFault> faults;
  demand_order(faults, rates.freeze_least_s, rates.freeze_most_s, "freeze_least_s", "freeze_most_s");
  if (rates.named.size() > kMostNamedFaults)
    faults.push_back({"named", fmt::format("{} are too many; use at most {}", rates.named.size(), kMostNamedFaults)});
  for (auto named = rates.named.begin(); named != rates.named.end(); ++named) {
    const auto first = std::ranges::find(rates.named, named->word, &NamedFaultRate::word);
    if (first != named && !named->word.empty())
      faults.push_back({"named", fmt::format("{} stands twice; give each word once", in_quotes(named->word))});
  }
  return faults;
}

FaultRates ComputerFaultRates::as_rates() const {
  FaultRates rates;
  rates.restarts_per_agv_hour = restarts_per_hour;
  rates.restart_s = restart_s;
  rates.power_failures_per_agv_hour = power_failures_per_hour;
  rates.power_back_s = power_back_s;
  rates.freezes_per_agv_hour = freezes_per_hour;
  rates.freeze_least_s = freeze_least_s;
  rates.freeze_most_s = freeze_most_s;
  rates.disk_losses_per_agv_hour = disk_losses_per_hour;
  rates.disk_loss_s = disk_loss_s;
  return rates;
}

}  // namespace fleetproof
