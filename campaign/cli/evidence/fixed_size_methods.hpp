#pragma once

#include "campaign/cli/evidence/evidence_methods.hpp"

namespace fleetproof::cli {

// Methods that hold for a number of trials, or an exposure, that was fixed beforehand.
std::span<const EvidenceMethod> fixed_size_methods();

}  // namespace fleetproof::cli
