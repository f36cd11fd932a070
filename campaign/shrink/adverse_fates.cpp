#include "campaign/shrink/adverse_fates.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fleetproof {

bool is_same_message(const GivenFate& a, const GivenFate& b) {
  return a.sender == b.sender && a.receiver == b.receiver && a.sent == b.sent && a.ordinal == b.ordinal;
}

std::vector<MessageFate> adverse_of(const std::vector<MessageFate>& fates) {
  std::vector<MessageFate> adverse;
  std::ranges::copy_if(fates, std::back_inserter(adverse), &MessageFate::is_adverse);
  return adverse;
}

RadioSetup perfect(const RadioSetup& radio) {
  RadioSetup perfect;
  perfect.range_m = radio.range_m;
  perfect.air_time_s = radio.air_time_s;
  perfect.air_time_per_byte_s = radio.air_time_per_byte_s;
  return perfect;
}

RadioSetup without_loss(RadioSetup radio) {
  radio.loss = radio.asymmetry = radio.range_falloff_m = 0.0;
  radio.outages = {};
  radio.places = {};
  radio.contention = {};
  radio.sources.clear();
  radio.trace = nullptr;
  return radio;
}

Scenario with_fates_only(const Scenario& scenario, std::vector<GivenFate> fates) {
  Scenario given = scenario;
  given.radio = perfect(scenario.radio);
  given.fates = std::move(fates);
  return given;
}

}  // namespace fleetproof
