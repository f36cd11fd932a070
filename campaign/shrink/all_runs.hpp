#pragma once

#include <vector>

#include "campaign/shrink/trials.hpp"

namespace fleetproof {

// Simulates all candidates on all workers. In their order; none for those that make no sense.
std::vector<std::optional<CaseRun>> all_runs(CaseHost& host, const Candidates& candidates,
                                             Deliveries deliveries = Deliveries::Ignored);

}  // namespace fleetproof
