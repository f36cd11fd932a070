#include "reports/plan_facts.hpp"

#include <nlohmann/json.hpp>

namespace fleetproof {

std::optional<double> safety_distance_m(const std::string& plan_json) {
  const auto plan = nlohmann::json::parse(plan_json, nullptr, false);
  const nlohmann::json::json_pointer place("/law/safety_distance_m");
  if (plan.is_discarded() || !plan.contains(place) || !plan.at(place).is_number()) return std::nullopt;
  return plan.at(place).get<double>();
}

}  // namespace fleetproof
