#pragma once

#include <span>
#include <string_view>

namespace fleetproof::cli {

// Control software to start from, which `new agent` writes. In its texts stands `placeholder` for the name of the
// agent, and @PROGRAM@ in the campaign for what a campaign calls the program.
struct AgentStart {
  std::string_view language, style, placeholder, source, campaign;
};

// In the order in which they are listed. Each language has "callbacks".
std::span<const AgentStart> agent_starts();

}  // namespace fleetproof::cli
