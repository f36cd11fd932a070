#pragma once

#include <cstdint>
#include <vector>

#include "campaign/batch/sensitivity.hpp"
#include "reports/sensitivity/sensitivity_record.hpp"

namespace fleetproof::cli {

// What was measured in the worlds of a plan with one seed.
struct SeededSensitivity {
  std::uint64_t seed = 0;
  Sensitivity found;
};

// All seeds together: medians, and what most of them say. Requires: at least one seed, and the same faults in each.
// `programs` describes the agents.
SensitivityRecord summary_of(const CampaignPlan& plan, const AgentPrograms& programs,
                             const std::vector<SeededSensitivity>& measured);

}  // namespace fleetproof::cli
