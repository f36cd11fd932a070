#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// What was sampled: "200 worlds at these 12 combinations (...), layout ring, fleets of 5, 600 s a run". A verdict
// claims no more than this. If loss and delay were drawn between bounds, the sentence names the region: "200 worlds
// wherever loss <= 40 % and delay <= 2 s, drawn uniformly ...".
std::string sampled(const Evidence& evidence, const std::vector<std::uint32_t>& cells);

// The losses and delays of these cells, in short: "loss 0 %, 40 %; delay 1 s", or "loss <= 40 %; delay <= 2 s" if they
// were drawn. Requires: there is a cell.
std::string sampled_quality(const Evidence& evidence, const std::vector<std::uint32_t>& cells);

// Every format prints this before its verdicts: the places and pairs that are exempt from the safety distance, and the
// held streams of randomness.
std::vector<Headline> reservations(const ReportInput& input);

}  // namespace fleetproof
