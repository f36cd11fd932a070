#pragma once

#include "campaign/cli/evidence/evidence_methods.hpp"

namespace fleetproof::cli {

// Methods that compare two releases.
std::span<const EvidenceMethod> comparison_methods();

}  // namespace fleetproof::cli
