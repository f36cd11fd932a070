#pragma once

#include "campaign/shrink/shrinker.hpp"

namespace fleetproof {

// What may happen to one message: it is lost, or `late`. The messages shortly before `until` come first.
std::vector<GivenFate> troubles_of(const std::vector<MessageFate>& messages, SimTime until, Duration late);

// Passes on the fates of messages and on numbers. Each says whether it found a smaller case.

// The radio is perfect, and the fates that it had drawn are given.
bool write_fates_down(Shrinker& shrinker);
// Goes through the run from front to back: what was bad luck up to an instant is written down, as little of it as
// suffices; behind it the radio still draws. In the end everything is written down.
bool write_least_fates_down(Shrinker& shrinker);
bool take_out_fates(Shrinker& shrinker);
// One or two messages on an otherwise perfect radio, instead of more.
bool find_fewer_fates(Shrinker& shrinker);
bool simplify_numbers(Shrinker& shrinker);

}  // namespace fleetproof
