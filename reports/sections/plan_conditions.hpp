#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// The minimal safety distance that the laws of a stored plan judged by. None if the plan does not say.
std::optional<double> safety_distance_m(const std::string& plan_json);

// A recording of a real radio that replaces loss and delay of the pairs of AGVs in it. A pair: a sender and a receiver.
struct RecordingFacts {
  std::size_t pairs = 0, messages = 0, lost = 0;
};
// None if the radio of a stored plan is not recorded.
std::optional<RecordingFacts> recorded_radio(const std::string& plan_json);

// A name and its value, such as {"Fleet sizes", "5, 10"}.
using Fact = std::pair<std::string, std::string>;

// The conditions of a campaign, from the plan as its file stores it: safety distance, laws, agents, layouts, fleets,
// vehicles, transports, radio, faults, horizon. Empty if the text is no plan.
std::vector<Fact> plan_conditions(const std::string& plan_json);

// The same, and what was run of it: cells, runs, hours, software, plan digest.
std::vector<Fact> campaign_conditions(const ReportInput& input);

// The plan with one value in each line. Embedded layouts and long lists are shortened; a text that is still longer than
// `most_bytes` is cut, and says so.
std::string plan_listing(const std::string& plan_json, std::size_t most_bytes);

}  // namespace fleetproof
