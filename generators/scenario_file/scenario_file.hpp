// Scenario files: reading one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

inline constexpr std::int64_t kScenarioFileVersion = 1;

// A scenario as one JSON file. The layout is part of the file; stations, segments and vehicle types are named. Fields
// that are left out have their defaults: `fleetproof list fields` lists all of them. "version", "layout", "agvs" and
// the names of stations must be there. A duration is written either as seconds ("horizon_s": 12) or as whole
// nanoseconds ("horizon_ns": 12000000000). A heading of any length is made a unit vector.
//
// Throws InputError with file, line, field, value and remedy for the first problem that `unusable_problems`
// (validator.hpp) lists. A scenario that is only a poor test (for example, with a weakly connected layout) is accepted.
Scenario read_scenario(const std::string& path);
Scenario parse_scenario(std::string_view text, std::string_view source);
// A text without a layout (`text_without_layout`), on the map that its scenario had.
Scenario parse_scenario_on(std::shared_ptr<const LogicalMap> map, std::string_view text, std::string_view source);

}  // namespace fleetproof
