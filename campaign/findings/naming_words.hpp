#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "campaign/findings/finding.hpp"

namespace fleetproof {

// Whether its agents had said what the trait names, though it may be too seldom compared to tell.
bool says(const FailureNeeds& failure, const std::string& trait);

// Failures, by their naming words: words that tell failures from other runs nearly wherever they are said, while other
// failures are without them. A word that is also said for other reasons ("late-grant") is none. The words are traits,
// sorted.
std::map<std::vector<std::string>, std::vector<std::size_t>> by_naming_words(std::span<const KnownFailure> failures,
                                                                             const std::vector<std::size_t>& members);

}  // namespace fleetproof
