#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reports/page.hpp"

namespace fleetproof {

// "200 replicates at these 12 combinations (...), layout ring, fleets of 5, 600 s a run": a verdict claims no more than
// this. Where loss and delay were drawn between bounds, it names the region: "200 replicates wherever loss <= 40 % and
// delay <= 2 s, drawn uniformly ...".
std::string sampled(const Evidence& evidence, const std::vector<std::uint32_t>& cells);

// What every format says before its verdicts: places and pairs of bodies that are exempt from the safety distance, and
// randomness that was held.
std::vector<Headline> reservations(const ReportInput& input);

}  // namespace fleetproof
