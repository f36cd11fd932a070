// The two programs of a central fleet, for the C table: follower on board, zone-server on the computer.
#pragma once

#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::central {

extern const fp_agent_type kFollower;
extern const fp_agent_type kZoneServer;

// So often, about, a follower sends its State, and the server what has not arrived: their timer.
inline constexpr double kPulse_s = 0.5;
inline constexpr std::uint32_t kPulseTimer = 1, kPulseDraws = 1;

// Whether a program for this role can start here. If it cannot, it says why.
bool can_start(const fp_host& host, fp_controller* controller, const fp_briefing& briefing, fp_role role);

}  // namespace fleetproof::agents::central
