#pragma once

#include <cstdint>

// What the safety and the progress of hull-lock rest on, one member for each rule. The defaults are the sound agent.
// Each agent of core/agents/faulty breaks one rule.
namespace fleetproof::agents {

// Which floor a hull covers.
struct HullOptions {
  bool loads_count = true;       // a body has its size with a load
  bool sizes_differ = true;      // another AGV has the size of its own type
  bool centres_differ = true;    // bodies of one size differ in where their reference point is
  bool turns_count = true;       // a turn on the spot covers floor
  bool corners_count = true;     // such a turn reaches as far as the corners of the body, not only as far as its ends
  bool directions_count = true;  // a body that drives backward lies on the other side of its reference point
  bool bends_count = true;       // a lane is its curve, not the straight line between its stations
  bool margin_is_whole = true;   // false: hulls keep half the safety distance
  bool shapes_decide = true;     // false: paths conflict if they share a station
};

// What counts as consent.
struct ConsentOptions {
  std::int64_t silence_consents_after_ns = 0;  // an AGV that has not answered for so long; 0: silence is never consent
  bool stamps_count = true;        // the newest message is the one that was sent last, not the one that came last
  bool answers_name_epoch = true;  // a GRANT counts only for the request that it answers
  bool senders_count = true;       // false: a second GRANT of one AGV counts as the GRANT of another
  bool proofs_age = true;          // an AGV that was far away may have come nearer since
  bool places_spread = true;       // false: it has gone on as it did between its last two positions
  bool epochs_name_boot = true;    // false: a restarted AGV uses the numbers of its requests again
  bool epochs_grow = true;         // false: 0 comes after 255
  bool ways_are_heard = true;      // an AGV counts on the newest way that it has heard of
};

// What a request does that has granted a conflicting one.
enum class Overtaken : std::uint8_t { StepsBack, StepsBackIfGranted, DropsThatGrant, GoesOn };

// What is granted.
struct GrantOptions {
  bool bodies_count = true;             // a standing AGV holds the floor under it
  bool unknown_place_defers = true;     // a restarted AGV that does not know its heading grants nothing
  bool grants_name_epoch = true;        // false: a grant is for all later requests of that AGV
  std::int64_t locks_end_after_ns = 0;  // a lock is over after so long; 0: time releases nothing
  Overtaken overtaken = Overtaken::StepsBack;
};

// What an AGV goes on holding.
struct HoldingOptions {
  bool lanes_to_their_end = true;   // false: a lane is released 2 s before its end
  bool lanes_over_restarts = true;  // the lane that a restarted AGV may still be driving
  bool turns_over_restarts = true;  // the turn before that lane
  bool lanes_over_failures = true;  // the lane on which an AGV stopped that is out of order
};

// What progress rests on.
struct ProgressOptions {
  bool asks_again = true;            // a REQUEST without an answer is sent again
  bool makes_way = true;             // an AGV leaves a place that others need
  bool order_is_common = true;       // of two requests, both AGVs let the same one go first, not each the other's
  bool smaller_number_first = true;  // of two demands of the same age
  bool one_way_aisles = true;        // AGVs of a crowded fleet prefer one direction of a long aisle
  bool whole_sections = true;        // an AGV locks the way to a waiting place at once, not lane by lane
};

struct LockOptions {
  HullOptions hulls{};
  ConsentOptions consent{};
  GrantOptions grants{};
  HoldingOptions holding{};
  ProgressOptions progress{};
};

}  // namespace fleetproof::agents
