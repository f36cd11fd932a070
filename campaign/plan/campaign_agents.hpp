#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/toml_table.hpp"

namespace fleetproof {

// Before the command of a program that speaks lockstep, where an agent is named.
inline constexpr std::string_view kLockstepWord = "lockstep:";

// Whether a word where an agent is named is no name: the path of a shared object, or a command; either with faults
// around it (core/bridges/wrapped).
bool is_path_of_object(std::string_view word);

// Of each part of an agent, that on board first: the path of its shared object, beside the campaign file, or the word
// of its command, with the faults around it. Empty: it is built in.
using AgentFiles = std::vector<std::string>;

// Reads factors.agents: "hull-lock", "my.so", { file = "my.so", name = "candidate", config = "patience=3" }, or
// { agent = "hull-lock", ... }, with role = "candidate" or "reference". Central fleet software names a part for the
// vehicles and one for each computer: { vehicle = "follower", computer = "zone-server" }, or computers = { broker =
// ..., master = ... }; each part is a word or a table as above. { run = "python3 master.py", way = "lockstep" } stands
// wherever { file = ... } may. `with = "stall 3 s every 200 s"` puts a fault around a program; in a word it stands
// behind the name: "hull-lock with clock 5 s off". A part of a shared object has no program yet: the object has to be
// asked. The only computer of a campaign needs no name here. Throws InputError.
void read_agents(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                 std::vector<AgentFactor>& agents, std::vector<AgentFiles>& files);

}  // namespace fleetproof
