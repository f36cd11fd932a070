#include "campaign/findings/ingredients.hpp"

#include <algorithm>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kKindEnd = " messages";

void right_sensing(Scenario& scenario) {
  for (AgvSetup& agv : scenario.agvs) agv.sensing = {};
}

void no_copies(Scenario& scenario) {
  scenario.radio.duplicates = 0.0;
  for (GivenDelivery& delivery : scenario.deliveries) delivery.copied = false;
}

void full_batteries(Scenario& scenario) {
  for (AgvSetup& agv : scenario.agvs) agv.battery = 1.0;
}

void weightless_loads(Scenario& scenario) {
  for (VehicleType& type : scenario.vehicle_types) type.loaded = {};
}

void no_delay(Scenario& scenario) {
  scenario.radio.delay_s = 0.0;
  for (GivenDelivery& delivery : scenario.deliveries) delivery.delay = Duration::zero();
}

void no_loss(Scenario& scenario) {
  scenario.radio = without_loss(scenario.radio);
  for (GivenDelivery& delivery : scenario.deliveries) delivery.lost = false;
}

void no_kind(Scenario& scenario, const std::string& kind) {
  auto& spared = scenario.radio.adverse.spared_kinds;
  spared.insert(std::ranges::lower_bound(spared, kind), kind);
}

std::vector<Ingredient> all_ingredients(const Scenario& scenario) {
  std::vector<Ingredient> all;
  all.push_back({"wrong clocks or positions", right_sensing});
  all.push_back({kCopiedMessages, no_copies});
  for (const Fault::Kind kind : kValuesOf<Fault::Kind>)
    all.push_back({name_of(kind), [kind](Scenario& s) {
                     std::erase_if(s.faults, [kind](const Fault& fault) { return fault.kind == kind; });
                   }});
  if (!scenario.obstacles.empty()) all.push_back({"obstacles", [](Scenario& s) { s.obstacles.clear(); }});
  all.push_back({"low batteries", full_batteries});
  all.push_back({"bodies that change with a load", weightless_loads});
  all.push_back({kLateMessages, no_delay});
  all.push_back({kLostMessages, no_loss});
  return all;
}

}  // namespace

std::vector<Ingredient> ingredients_of(const Scenario& scenario, std::span<const std::string> kinds) {
  std::vector<Ingredient> all = all_ingredients(scenario);
  const std::uint64_t digest = scenario_digest(scenario);
  std::erase_if(all, [&](const Ingredient& ingredient) {
    Scenario without = scenario;
    ingredient.take_out(without);
    return scenario_digest(without) == digest;
  });
  for (const std::string& kind : kinds)
    all.push_back({kind + std::string(kKindEnd), [kind](Scenario& s) { no_kind(s, kind); }});
  return all;
}

bool names_all(const std::vector<std::string>& needs, const std::vector<std::string>& some) {
  return std::ranges::all_of(some, [&](const std::string& word) { return std::ranges::count(needs, word) > 0; });
}

std::vector<std::string> without_kinds(std::vector<std::string> needs) {
  std::erase_if(needs, [](const std::string& need) {
    return need.ends_with(kKindEnd) && need != kLateMessages && need != kLostMessages && need != kCopiedMessages;
  });
  return needs;
}

}  // namespace fleetproof
