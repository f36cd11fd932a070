#pragma once

#include <vector>

#include "campaign/run/message_fates.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Whether both are fates of one message on its way to one receiver.
bool is_same_message(const GivenFate& a, const GivenFate& b);

std::vector<MessageFate> adverse_of(const std::vector<MessageFate>& fates);

// A radio on which every message arrives at once and once, as far as it did.
RadioSetup perfect(const RadioSetup& radio);

// A radio that loses no message. A recording has losses and delays in one; without it, the models draw.
RadioSetup without_loss(RadioSetup radio);

// The same scenario with its bad luck written down: on a perfect radio, the given fates alone are adverse.
Scenario with_fates_only(const Scenario& scenario, std::vector<GivenFate> fates);

}  // namespace fleetproof
