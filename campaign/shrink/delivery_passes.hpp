#pragma once

#include "campaign/shrink/shrinker.hpp"

namespace fleetproof {

// What may happen to one message: it is lost, or `late`. The messages shortly before `until` come first.
std::vector<GivenDelivery> troubles_of(const std::vector<MessageDelivery>& messages, SimTime until, Duration late);

// Passes on the deliveries of messages and on numbers. Each says whether it found a smaller case.

// The radio is perfect, and the deliveries that it had drawn are given.
bool write_deliveries_down(Shrinker& shrinker);
// Goes through the run from front to back: the losses and delays up to an instant are written down, as few of them
// as suffice; behind it the radio still draws. In the end everything is written down.
bool write_least_deliveries_down(Shrinker& shrinker);
bool take_out_deliveries(Shrinker& shrinker);
// One or two messages on an otherwise perfect radio, instead of more.
bool find_fewer_deliveries(Shrinker& shrinker);
bool simplify_numbers(Shrinker& shrinker);

}  // namespace fleetproof
