#pragma once

#include <string_view>

namespace fleetproof {

// The JSON Schema (draft 2020-12) of `report --format json`, as report.schema.json has it.
std::string_view report_schema();

}  // namespace fleetproof
