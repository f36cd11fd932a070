#pragma once

#include <vector>

#include "campaign/run/message_deliveries.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Whether both are deliveries of one message on its way to one receiver.
bool is_same_message(const GivenDelivery& a, const GivenDelivery& b);

std::vector<MessageDelivery> adverse_of(const std::vector<MessageDelivery>& deliveries);

// A radio on which every message arrives at once and once, as far as it did.
RadioSetup perfect(const RadioSetup& radio);

// A radio that loses no message. A recording has losses and delays in one; without it, the models draw.
RadioSetup without_loss(RadioSetup radio);

// The same scenario with its losses and delays written down: on a perfect radio, the given deliveries alone are
// adverse.
Scenario with_deliveries_only(const Scenario& scenario, std::vector<GivenDelivery> deliveries);

}  // namespace fleetproof
