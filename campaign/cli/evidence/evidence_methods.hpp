#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "campaign/cli/evidence/evidence_input.hpp"
#include "campaign/cli/evidence/figures.hpp"

namespace fleetproof::cli {

// One estimator as a user calls it. `arguments` are names of evidence_arguments(), those in brackets may be left out.
struct EvidenceMethod {
  std::string_view name, arguments, description;
  Figures (*compute)(const EvidenceInput& input);
};

// For a number of runs that was fixed before.
std::span<const EvidenceMethod> fixed_size_methods();
// For runs that are looked at while they come.
std::span<const EvidenceMethod> sequential_methods();
// For runs that fall into groups: strata of a profile, cells of a grid, clusters.
std::span<const EvidenceMethod> grouped_methods();
// For two releases.
std::span<const EvidenceMethod> comparison_methods();

// All methods, in the order in which `fleetproof evidence` lists them.
std::vector<EvidenceMethod> evidence_methods();

}  // namespace fleetproof::cli
