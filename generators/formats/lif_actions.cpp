#include "generators/formats/lif_actions.hpp"

#include <algorithm>
#include <iterator>

namespace fleetproof {
namespace {

Purposes purpose_of_action(std::string_view type, const PurposeWords& own) {
  if (const auto said = own.said_of(type)) return *said;
  if (type == "pick" || type == "drop") return Purpose::Storage;
  return type == "startCharging" ? Purposes(Purpose::Charging) : Purposes::from_bits(0);
}

// LIF 1.0 has one list of them, its successor two.
std::vector<JsonReader> actions_of(const JsonReader& rule) {
  std::vector<JsonReader> all;
  for (const char* key : {"actions", "requiredActions", "feasibleActions"}) {
    if (const auto list = rule.find(key)) std::ranges::copy(list->items(), std::back_inserter(all));
  }
  return all;
}

}  // namespace

Purposes purposes_of_actions(const std::vector<JsonReader>& rules, const PurposeWords& own) {
  auto purposes = Purposes::from_bits(0);
  for (const auto& rule : rules) {
    for (const auto& action : actions_of(rule))
      purposes = purposes | purpose_of_action(action.at("actionType").text(), own);
  }
  return purposes;
}

bool forbid_transfers(const std::vector<JsonReader>& rules) {
  return std::ranges::any_of(rules, [](const JsonReader& rule) {
    const auto forbidden = rule.find("forbiddenActionTypes");
    return forbidden && std::ranges::any_of(forbidden->items(), [](const JsonReader& type) {
             return type.text() == "pick" || type.text() == "drop";
           });
  });
}

}  // namespace fleetproof
