#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "campaign/findings/neighbourhood.hpp"

namespace fleetproof {

// The scenario with each AGV at another station, drawn anew for each number. Absent: none of the stations that were
// drawn lets all AGVs stand and drive off.
std::optional<Scenario> elsewhere(Scenario scenario, std::uint32_t number);

// How far the fleets of a kept failure drive where nothing is in their way but each other: elsewhere, on a perfect
// radio, without faults and obstacles. In whole metres, of 100 runs together. Software that stands beside the failure,
// but not here, stands there because it has to wait.
std::uint64_t driven_elsewhere_m(CaseHost& host, const KeptFailure& kept);

// Failures of the kept world elsewhere that are the kept one, reduced: `most` of them, if 400 tries give so many.
std::vector<FailingCase> same_failure_elsewhere(CaseHost& host, const KeptFailure& kept, std::size_t most);

}  // namespace fleetproof
