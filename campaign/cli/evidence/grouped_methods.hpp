#pragma once

#include "campaign/cli/evidence/evidence_methods.hpp"

namespace fleetproof::cli {

// Methods for runs that fall into groups: strata of a profile, cells of a grid, clusters.
std::span<const EvidenceMethod> grouped_methods();

}  // namespace fleetproof::cli
