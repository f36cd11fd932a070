#pragma once

#include <string_view>

namespace fleetproof {

// The agent that plays the scripts of a scenario. It sends no messages.
inline constexpr std::string_view kScriptedAgent = "scripted";

// Whether an agent of this name plays scripts: the scripted agent, also with faults around it, as in "scripted with
// clock 5 s off" (core/bridges/wrapped).
inline bool plays_scripts(std::string_view agent) {
  return agent == kScriptedAgent ||
         (agent.starts_with(kScriptedAgent) && agent.substr(kScriptedAgent.size()).starts_with(" with "));
}

}  // namespace fleetproof
