#pragma once

#include <string>
#include <string_view>

#include "campaign/plan/toml_table.hpp"

namespace fleetproof {

// What is wrong with the name of a campaign, an agent, a layout or a gate; null: nothing.
const char* fault_of_plan_name(std::string_view name);

// Reads `name = "..."` of a table. Without the key, `name` stays as it is. Throws InputError for a name that is
// refused.
void take_name(TomlTable& table, std::string& name);

}  // namespace fleetproof
