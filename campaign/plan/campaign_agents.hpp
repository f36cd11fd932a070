#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/toml_table.hpp"

namespace fleetproof {

// Whether a word where an agent is named is the path of a shared object.
bool is_path_of_object(std::string_view word);

// Reads factors.agents: "hull-lock", "my.so", { file = "my.so", name = "candidate", config = "patience=3" }, or
// { agent = "hull-lock", ... }, with role = "candidate" or "reference". `files` gets the path of the shared object of
// each agent, beside the campaign file; empty for a reference agent. An agent of a shared object has no program yet:
// the object has to be asked. Throws InputError.
void read_agents(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                 std::vector<AgentFactor>& agents, std::vector<std::string>& files);

}  // namespace fleetproof
