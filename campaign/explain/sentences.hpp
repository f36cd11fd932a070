#pragma once

#include <string>
#include <vector>

#include "campaign/explain/explanation.hpp"

namespace fleetproof {

// The explanation in words. A sentence that rests on single runs ends with their numbers, "[3, 4]", as claims_of counts
// them, from 1 on.
std::vector<std::string> sentences_of(const Explanation& explanation);

}  // namespace fleetproof
