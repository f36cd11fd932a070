// The reference agents with one planted fault each. Every agent breaks one rule; otherwise it is the sound one.
#include "core/agents/faulty/faulty_agents.hpp"

#include "core/agents/central/programs.hpp"
#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {

using central::FollowerOptions;
using central::ServerOptions;

template <LockOptions options>
constexpr FaultyAgent lock_with(const char* name, const char* description) {
  return {&kHullLock, faulty_hull_lock<options>(name, description)};
}
template <ServerOptions options>
constexpr FaultyAgent server_with(const char* name, const char* description) {
  return {&central::kZoneServer, central::program<options>(name, description)};
}
template <FollowerOptions options>
constexpr FaultyAgent follower_with(const char* name, const char* description) {
  return {&central::kFollower, central::program<options>(name, description)};
}

constinit const FaultyAgent kTable[] = {
    // FAULT: an AGV that has not answered for 3 s counts as having granted.
    lock_with<LockOptions{.consent = {.silence_consents_after_ns = 3 * kSecond_ns}}>(
        "timeout-grant", "hull-lock with a fault: takes 3 s of silence for consent"),
    // FAULT: a turn on the spot is not in the hull.
    lock_with<LockOptions{.hulls = {.turns_count = false}}>(
        "no-turn-sweep", "hull-lock with a fault: locks no floor for turns on the spot"),
    // FAULT: the hull of a turn on the spot reaches half the length of the body, not half the diagonal.
    lock_with<LockOptions{.hulls = {.corners_count = false}}>(
        "no-half-diagonal", "hull-lock with a fault: leaves out the corners of a body that turns"),
    // FAULT: hulls have the size of the AGV without a load.
    lock_with<LockOptions{.hulls = {.loads_count = false}}>(
        "no-overhang", "hull-lock with a fault: leaves out what a load adds to its vehicle"),
    // FAULT: every other AGV is taken to be as large as this one.
    lock_with<LockOptions{.hulls = {.sizes_differ = false}}>(
        "one-size-for-all", "hull-lock with a fault: takes all AGVs to be as large as itself"),
    // FAULT: two bodies of one size are taken for the same, wherever their reference points are.
    lock_with<LockOptions{.hulls = {.centres_differ = false}}>(
        "kinds-by-size", "hull-lock with a fault: knows bodies by their size alone"),
    // FAULT: hulls have the body on the wrong side of its reference point where an AGV drives backward.
    lock_with<LockOptions{.hulls = {.directions_count = false}}>(
        "backward-as-forward", "hull-lock with a fault: takes backward driving for forward driving"),
    // FAULT: the hull of a lane is that of the straight line between its stations.
    lock_with<LockOptions{.hulls = {.bends_count = false}}>("bends-as-chords",
                                                            "hull-lock with a fault: takes every bend as its chord"),
    // FAULT: hulls keep half the safety distance.
    lock_with<LockOptions{.hulls = {.margin_is_whole = false}}>(
        "half-margin", "hull-lock with a fault: keeps half the safety distance"),
    // FAULT: two paths conflict only if they share a station.
    lock_with<LockOptions{.hulls = {.shapes_decide = false}}>("names-not-shapes",
                                                              "hull-lock with a fault: compares stations, not shapes"),
    // FAULT: the message that came last counts, not the one that was sent last.
    lock_with<LockOptions{.consent = {.stamps_count = false}}>(
        "arrival-order", "hull-lock with a fault: takes the last message to come for the newest"),
    // FAULT: a GRANT counts for whatever request is open, even if it answers an earlier one.
    lock_with<LockOptions{.consent = {.answers_name_epoch = false}}>(
        "stale-grant", "hull-lock with a fault: takes a grant for an earlier request as one for this request"),
    // FAULT: a second GRANT of the same AGV counts as that of another AGV.
    lock_with<LockOptions{.consent = {.senders_count = false}}>("counts-messages",
                                                                "hull-lock with a fault: counts messages, not senders"),
    // FAULT: an AGV that was far away once is taken to be there still.
    lock_with<LockOptions{.consent = {.proofs_age = false}}>("ageless-proof",
                                                             "hull-lock with a fault: ignores the age of a position"),
    // FAULT: an AGV is taken to have gone on as between its last two positions.
    lock_with<LockOptions{.consent = {.places_spread = false}}>("straight-on",
                                                                "hull-lock with a fault: extrapolates positions"),
    // FAULT: an AGV whose way keeps clear need not have heard of the request.
    lock_with<LockOptions{.consent = {.ways_are_heard = false}}>(
        "unheard-way", "hull-lock with a fault: counts on ways before its own has been heard"),
    // FAULT: after a restart, requests have the numbers of earlier requests once more.
    lock_with<LockOptions{.consent = {.epochs_name_boot = false}}>(
        "forgets-boot", "hull-lock with a fault: numbers its requests without the boot"),
    // FAULT: the number of a request has eight bits.
    lock_with<LockOptions{.consent = {.epochs_grow = false}}>(
        "wraps-at-256", "hull-lock with a fault: numbers its requests modulo 256"),
    // FAULT: an AGV that stands grants the floor under it.
    lock_with<LockOptions{.grants = {.bodies_count = false}}>("ignores-parked",
                                                              "hull-lock with a fault: holds no floor while it stands"),
    // FAULT: after a restart at rest, an AGV grants everything until it knows its heading.
    lock_with<LockOptions{.grants = {.unknown_place_defers = false}}>(
        "grants-at-boot", "hull-lock with a fault: grants everything right after a restart"),
    // FAULT: an AGV that granted one request grants all later requests of the same AGV.
    lock_with<LockOptions{.grants = {.grants_name_epoch = false}}>(
        "grants-for-good", "hull-lock with a fault: grants all requests of an AGV once it has granted one"),
    // FAULT: 20 s after it locked, an AGV grants what it holds.
    lock_with<LockOptions{.grants = {.locks_end_after_ns = 20 * kSecond_ns}}>(
        "lock-expires", "hull-lock with a fault: lets its lock end after 20 s"),
    // FAULT: a request that has granted a conflicting one goes on as if it had not.
    lock_with<LockOptions{.grants = {.overtaken = Overtaken::GoesOn}}>(
        "overtaken-goes-on", "hull-lock with a fault: does not begin a new epoch after a grant"),
    // FAULT: a request that grants a conflicting one gives back the other AGV's grant, but begins no new epoch.
    lock_with<LockOptions{.grants = {.overtaken = Overtaken::DropsThatGrant}}>(
        "overtaken-drops-grant", "hull-lock with a fault: gives back a grant instead of beginning a new epoch"),
    // FAULT: a request that grants a conflicting one begins a new epoch only if it has the other AGV's grant
    // already.
    lock_with<LockOptions{.grants = {.overtaken = Overtaken::StepsBackIfGranted}}>(
        "overtaken-if-granted", "hull-lock with a fault: begins a new epoch only if it was granted"),
    // FAULT: of two demands of the same age, neither comes first.
    lock_with<LockOptions{.progress = {.smaller_number_first = false}}>(
        "tie-without-number", "hull-lock with a fault: has no rule for demands of the same age"),
    // FAULT: a lane is released 2 s before its end.
    lock_with<LockOptions{.holding = {.lanes_to_their_end = false}}>(
        "early-release", "hull-lock with a fault: releases a lane 2 s before its end"),
    // FAULT: a restarted AGV holds the station where it was, not the lane that it drives.
    lock_with<LockOptions{.holding = {.lanes_over_restarts = false}}>(
        "restart-forgets-lane", "hull-lock with a fault: forgets at a restart what it drives"),
    // FAULT: a restarted AGV holds the lane that it drives, but not the turn before it.
    lock_with<LockOptions{.holding = {.turns_over_restarts = false}}>(
        "restart-forgets-turn", "hull-lock with a fault: forgets at a restart that it turns"),
    // FAULT: an AGV that is out of order releases the lane on which it stopped.
    lock_with<LockOptions{.holding = {.lanes_over_failures = false}}>(
        "failure-frees-lane", "hull-lock with a fault: releases its lane when it breaks down"),
    // FAULT: a REQUEST is never sent again.
    lock_with<LockOptions{.progress = {.asks_again = false}}>("asks-once",
                                                              "hull-lock with a fault: never repeats a request"),
    // FAULT: of two AGVs that request the same floor, each lets the other go first.
    lock_with<LockOptions{.progress = {.order_is_common = false}}>(
        "both-step-back", "hull-lock with a fault: of two requests, each AGV lets the other go first"),
    // FAULT: an AGV never leaves a place that others need.
    lock_with<LockOptions{.progress = {.makes_way = false}}>("never-makes-way",
                                                             "hull-lock with a fault: makes way for nobody"),
    // FAULT: an AGV locks one lane at a time.
    lock_with<LockOptions{.progress = {.whole_sections = false}}>("lane-by-lane",
                                                                  "hull-lock with a fault: locks one lane at a time"),

    // A server with a planted fault. Its followers are sound.
    // FAULT: the floor of an AGV that has been silent for 50 s is free (a lease by the server's clock).
    server_with<ServerOptions{.silence_frees_after_ns = 50 * kSecond_ns}>(
        "lease-by-clock", "zone-server with a fault: frees the floor of an AGV that is silent for 50 s"),
    // FAULT: a server that has started without its book does not wait for AGVs that say that they are out of order.
    server_with<ServerOptions{.failed_ones_join = false}>(
        "reboot-frees-floor", "zone-server with a fault: knows no floor of failed AGVs when it starts"),
    // FAULT: what was granted is written to the disk every 10 s, so that a restart loses the newest grants.
    server_with<ServerOptions{.writes_every_ns = 10 * kSecond_ns}>(
        "grants-before-it-writes", "zone-server with a fault: writes to its disk every 10 s what it has granted"),
    // FAULT: a cancel that is under way ends what the AGV is to do when it answers, the next order too.
    server_with<ServerOptions{.cancels_name_an_order = false}>(
        "cancels-the-next-order", "zone-server with a fault: a cancel ends whatever order the AGV then has"),
    // FAULT: an AGV that fails before the first grant of its way arrives holds no floor, not even what is under it.
    server_with<ServerOptions{.failures_keep_floor = false}>(
        "error-frees-floor", "zone-server with a fault: an error that overtakes a grant frees the floor of the AGV"),
    // FAULT: an AGV that starts again before it was granted anything since its last start holds no floor until it
    // rests.
    server_with<ServerOptions{.restarts_keep_floor = false}>(
        "switched-on-unseen", "zone-server with a fault: frees the floor under an AGV whose computer starts"),
    // FAULT: an AGV that has restarted is asked for ever to finish what its former self was granted.
    server_with<ServerOptions{.restarts_are_believed = false}>(
        "waits-for-former-self", "zone-server with a fault: waits for what an AGV no longer knows"),
    // FAULT: a GRANT is never sent again.
    server_with<ServerOptions{.repeats_grants = false}>("grants-once",
                                                        "zone-server with a fault: never repeats a grant"),
    // FAULT: the way to a charger is granted lane by lane, though another AGV has the charger at its end.
    server_with<ServerOptions{.ways_to_chargers_are_whole = false}>(
        "charger-comes-later", "zone-server with a fault: grants the way to a charger without the charger"),

    // A follower with a planted fault. Its server is sound.
    // FAULT: an AGV that has done all its steps takes the first steps of its way for new ones when they are repeated.
    follower_with<FollowerOptions{.numbers_count = false}>(
        "takes-steps-twice", "follower with a fault: when it has no steps, it takes old ones for new"),
    // FAULT: a GRANT is taken for whatever way the AGV is on (no fencing).
    follower_with<FollowerOptions{.ways_count = false}>("no-fencing",
                                                        "follower with a fault: takes grants for former ways"),
    // FAULT: a plan made anew begins in the middle of a lane, and that lane belongs to nothing.
    follower_with<FollowerOptions{.ways_begin_at_rest = false}>(
        "replans-in-the-lane", "follower with a fault: begins a new way while it drives the old one"),
    // FAULT: a way is replaced while the AGV waits, and it goes on behind the gate without asking.
    follower_with<FollowerOptions{.former_steps_end = false}>(
        "goes-on-behind-the-gate", "follower with a fault: drives on with what a former server granted"),
    // FAULT: an AGV that breaks down while it drives on to the next lane gives this one back, with its body there.
    follower_with<FollowerOptions{.lanes_to_their_end = false}>(
        "frees-before-its-rear", "follower with a fault: gives a lane back before it is out, if it fails"),
    // FAULT: a request without an answer for 1 s counts as dropped, and what answers it later as a mistake.
    follower_with<FollowerOptions{.patience_ns = kSecond_ns}>(
        "drops-after-a-second", "follower with a fault: makes a request anew if no grant came for a second"),
};

}  // namespace

constinit const std::span<const FaultyAgent> kFaultyAgents = kTable;

}  // namespace fleetproof::agents
