#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

inline constexpr std::int64_t kScenarioFileVersion = 1;

// A scenario as one JSON file, layout embedded; stations, segments and vehicle types are referred to by name. Fields
// that are left out have their defaults: `fleetproof list fields` lists all of them. "version", "layout", "agvs" and
// the names must be there. A duration is written either as seconds ("horizon_s": 12) or as whole nanoseconds
// ("horizon_ns": 12000000000). A heading of any length is made a unit vector.
//
// InputError with file, line, field, value and remedy for anything that `unusable_problems` (validator.hpp) would list.
// A scenario that is merely a poor test (a weakly connected layout, say) is read: a person may want it.
Scenario read_scenario(const std::string& path);
Scenario parse_scenario(std::string_view text, std::string_view source);

// Canonical: every field, in fixed order, exact. parse_scenario of it gives the same text again, on every machine.
std::string to_text(const Scenario& scenario);

}  // namespace fleetproof
