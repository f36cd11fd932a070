#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/campaign_page/factor_map.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::html {

// The guaranteed envelope of one agent over the losses (rows) and delays (columns) of a map, in words and as a map.
struct EnvelopeMap {
  std::string sentence;
  FactorMap map;
};

// `places`: the condition of each field of `blank`, row by row; null: not tested. Absent without a gate (acceptance
// criterion) on violations that fixed a limit beforehand, in a search, if a field stands for a region, and if the
// bounds hold for more replicates than there are.
std::optional<EnvelopeMap> envelope_map(const Evidence& evidence, const std::string& agent,
                                        const std::vector<const Condition*>& places, FactorMap blank);

}  // namespace fleetproof::html
