#pragma once

#include <cstdint>

// The rules that make a central fleet safe and keep it moving, one member for each. The defaults are the sound
// programs. Each faulty program of core/agents/faulty breaks one rule.
namespace fleetproof::agents::central {

// Of the zone-server.
struct ServerOptions {
  std::int64_t silence_frees_after_ns = 0;  // the floor of an AGV that is silent for so long; 0: time frees nothing
  bool failed_ones_join = true;             // false: a server that starts does not wait for AGVs that are out of order
  bool failures_keep_floor = true;          // false: not of an AGV that fails before the first grant of its way
  bool restarts_keep_floor = true;          // false: not of an AGV that starts twice before it is granted anything
  bool restarts_are_believed = true;        // false: it first has to finish what its former self was granted
  std::int64_t writes_every_ns = 0;         // what was granted, to the disk; 0: before each grant is sent
  bool repeats_grants = true;               // until the AGV is known to have them
  bool cancels_name_an_order = true;        // false: they end what the AGV is to do when it answers
  bool ways_to_chargers_are_whole = true;   // an AGV on its way to a charger never waits in between
};

// Of the follower.
struct FollowerOptions {
  bool numbers_count = true;       // false: without steps, it takes the first ones of its way for new ones
  bool ways_count = true;          // a Grant is for one way only
  bool ways_begin_at_rest = true;  // false: a new way begins in the middle of a lane
  bool former_steps_end = true;    // what a former boot of the server granted is not driven any more
  bool lanes_to_their_end = true;  // false: an AGV that fails while it drives on to the next lane has left this one
  std::int64_t patience_ns = 0;    // a request that is not granted for so long is given up and made anew; 0: never
};

}  // namespace fleetproof::agents::central
