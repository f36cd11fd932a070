// The two programs of a central fleet: follower on board, zone-server on the computer. And the rules that make the
// fleet safe and keep it moving, one member for each: the defaults are the sound programs, and each faulty program of
// core/agents/faulty breaks one rule.
#pragma once

#include <cstdint>

#include "core/agents/agent_type.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::central {

struct ServerOptions {
  static constexpr fp_role kRole = FP_COMPUTER;
  std::int64_t silence_frees_after_ns = 0;  // the floor of an AGV that is silent for so long; 0: time frees nothing
  bool failed_ones_join = true;             // false: a server that starts does not wait for AGVs that are out of order
  bool failures_keep_floor = true;          // false: not of an AGV that fails before the first grant of its way
  bool restarts_keep_floor = true;          // false: not of an AGV that starts twice before it is granted anything
  bool restarts_are_believed = true;        // false: it first has to finish what its former self was granted
  std::int64_t writes_every_ns = 0;         // what was granted, to the disk; 0: before each grant is sent
  bool repeats_grants = true;               // until the AGV is known to have them
  bool cancels_name_an_order = true;        // false: they end what the AGV is to do when it answers
  bool ways_to_chargers_are_whole = true;   // they lead to a charger that is free, without waiting in between
};

struct FollowerOptions {
  static constexpr fp_role kRole = FP_AGV;
  bool numbers_count = true;       // false: without steps, it takes the first ones of its way for new ones
  bool ways_count = true;          // a Grant is for one way only
  bool ways_begin_at_rest = true;  // false: a new way begins in the middle of a lane
  bool former_steps_end = true;    // what a former boot of the server granted is not driven any more
  bool lanes_to_their_end = true;  // false: an AGV that fails while it drives on to the next lane has left this one
  std::int64_t patience_ns = 0;    // a request that is not granted for so long is given up and made anew; 0: never
};

// So often, about, a follower sends its State, and the server what has not arrived: their timer.
inline constexpr double kPulse_s = 0.5;
inline constexpr std::uint32_t kPulseTimer = 1, kPulseDraws = 1;

// Whether a program for this role can start here: not if there is no computer, or if the plant is too large for paths.
// If it cannot, it says why.
bool can_start(const fp_host& host, fp_controller* controller, const fp_briefing& briefing, fp_role role);
Program* create(const fp_host& host, fp_controller* controller, const fp_briefing& briefing, const ServerOptions&);
Program* create(const fp_host& host, fp_controller* controller, const fp_briefing& briefing, const FollowerOptions&);

// The program with these rules. `options`: of the zone-server or of the follower.
template <auto options>
constexpr fp_agent_type program(const char* name, const char* description) {
  fp_agent_type type = agent_type<Program>(
      name, description, [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
        if (!can_start(*host, controller, *briefing, options.kRole)) return nullptr;
        return create(*host, controller, *briefing, options);
      });
  if (options.kRole == FP_COMPUTER) type.flags |= FP_SERVES_COMPUTERS;
  return type;
}

extern const fp_agent_type kFollower;
extern const fp_agent_type kZoneServer;

}  // namespace fleetproof::agents::central
