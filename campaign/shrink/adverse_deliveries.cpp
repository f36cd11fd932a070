#include "campaign/shrink/adverse_deliveries.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fleetproof {

bool is_same_message(const GivenDelivery& a, const GivenDelivery& b) {
  return a.sender == b.sender && a.receiver == b.receiver && a.sent == b.sent && a.ordinal == b.ordinal;
}

std::vector<MessageDelivery> adverse_of(const std::vector<MessageDelivery>& deliveries) {
  std::vector<MessageDelivery> adverse;
  std::ranges::copy_if(deliveries, std::back_inserter(adverse), &MessageDelivery::is_adverse);
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

Scenario with_deliveries_only(const Scenario& scenario, std::vector<GivenDelivery> deliveries) {
  Scenario given = scenario;
  given.radio = perfect(scenario.radio);
  given.deliveries = std::move(deliveries);
  return given;
}

}  // namespace fleetproof
