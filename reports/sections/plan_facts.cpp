#include "reports/sections/plan_facts.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <utility>

namespace fleetproof {

std::optional<double> safety_distance_m(const std::string& plan_json) {
  const auto plan = nlohmann::json::parse(plan_json, nullptr, false);
  const nlohmann::json::json_pointer place("/law/safety_distance_m");
  if (plan.is_discarded() || !plan.contains(place) || !plan.at(place).is_number()) return std::nullopt;
  return plan.at(place).get<double>();
}

std::optional<RecordingFacts> recorded_radio(const std::string& plan_json) {
  const auto plan = nlohmann::json::parse(plan_json, nullptr, false);
  const nlohmann::json::json_pointer place("/radio/trace");
  if (plan.is_discarded() || !plan.contains(place) || !plan.at(place).is_array()) return std::nullopt;
  RecordingFacts radio;
  std::set<std::pair<nlohmann::json, nlohmann::json>> pairs;
  for (const auto& message : plan.at(place)) {  // [sender, receiver, sent_ns, delay_ns]; lost: without the delay
    if (!message.is_array() || message.size() < 3) continue;
    pairs.emplace(message[0], message[1]);
    ++radio.messages;
    radio.lost += message.size() == 3 ? 1 : 0;
  }
  radio.pairs = pairs.size();
  return radio.messages > 0 ? std::optional(radio) : std::nullopt;
}

}  // namespace fleetproof
