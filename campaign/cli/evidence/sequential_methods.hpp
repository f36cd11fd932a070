#pragma once

#include "campaign/cli/evidence/evidence_methods.hpp"

namespace fleetproof::cli {

// Methods that hold at every number of trials, so that one may look and stop at any time.
std::span<const EvidenceMethod> sequential_methods();

}  // namespace fleetproof::cli
