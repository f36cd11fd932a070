#pragma once

#include <span>
#include <string>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// What is wrong with an exempt pair, as a sentence with its remedy; empty: nothing. An exempt pair names two kinds of
// bodies that may be close to each other.
std::string fault_of_exempt_pair(const ExemptPair& pair, std::span<const std::string> vehicle_types);

// What is wrong if a pair has so many names; empty: nothing.
std::string fault_of_pair_size(std::size_t names);

// "tugger and cart", as pages say it.
std::string text_of(const ExemptPair& pair);

}  // namespace fleetproof
