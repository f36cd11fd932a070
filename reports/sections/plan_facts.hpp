#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace fleetproof {

// The minimal safety distance that the laws of a stored plan judged by. None if the plan does not say.
std::optional<double> safety_distance_m(const std::string& plan_json);

// A recording of a real radio that replaces loss and delay of the pairs of AGVs in it. A pair: a sender and a receiver.
struct RecordingFacts {
  std::size_t pairs = 0, messages = 0, lost = 0;
};
// None if the radio of a stored plan is not recorded.
std::optional<RecordingFacts> recorded_radio(const std::string& plan_json);

}  // namespace fleetproof
