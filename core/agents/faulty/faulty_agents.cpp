// hull-lock with one planted fault each. Every agent breaks one rule; otherwise it is hull-lock.
#include "core/agents/faulty/faulty_agents.hpp"

#include "core/agents/hull_lock.hpp"

namespace fleetproof::agents {
namespace {

constinit const fp_agent_type kTable[] = {
    // FAULT: an AGV that has not answered for 3 s counts as having granted.
    faulty_hull_lock<LockOptions{.consent = {.silence_consents_after_ns = 3 * kSecond_ns}}>(
        "timeout-grant", "hull-lock with a fault: takes 3 s of silence for consent"),
    // FAULT: a turn on the spot is not in the hull.
    faulty_hull_lock<LockOptions{.hulls = {.turns_count = false}}>(
        "no-turn-sweep", "hull-lock with a fault: locks no floor for turns on the spot"),
    // FAULT: the hull of a turn on the spot reaches half the length of the body, not half the diagonal.
    faulty_hull_lock<LockOptions{.hulls = {.corners_count = false}}>(
        "no-half-diagonal", "hull-lock with a fault: leaves out the corners of a body that turns"),
    // FAULT: hulls have the size of the AGV without a load.
    faulty_hull_lock<LockOptions{.hulls = {.loads_count = false}}>(
        "no-overhang", "hull-lock with a fault: leaves out what a load adds to its vehicle"),
    // FAULT: every other AGV is taken to be as large as this one.
    faulty_hull_lock<LockOptions{.hulls = {.sizes_differ = false}}>(
        "one-size-for-all", "hull-lock with a fault: takes all AGVs to be as large as itself"),
    // FAULT: two bodies of one size are taken for the same, wherever their reference points are.
    faulty_hull_lock<LockOptions{.hulls = {.centres_differ = false}}>(
        "kinds-by-size", "hull-lock with a fault: knows bodies by their size alone"),
    // FAULT: hulls have the body on the wrong side of its reference point where an AGV drives backward.
    faulty_hull_lock<LockOptions{.hulls = {.directions_count = false}}>(
        "backward-as-forward", "hull-lock with a fault: takes backward driving for forward driving"),
    // FAULT: the hull of a lane is that of the straight line between its stations.
    faulty_hull_lock<LockOptions{.hulls = {.bends_count = false}}>(
        "bends-as-chords", "hull-lock with a fault: takes every bend as its chord"),
    // FAULT: hulls keep half the safety distance.
    faulty_hull_lock<LockOptions{.hulls = {.margin_is_whole = false}}>(
        "half-margin", "hull-lock with a fault: keeps half the safety distance"),
    // FAULT: two paths conflict only if they share a station.
    faulty_hull_lock<LockOptions{.hulls = {.shapes_decide = false}}>(
        "names-not-shapes", "hull-lock with a fault: compares stations, not shapes"),
    // FAULT: the message that came last counts, not the one that was sent last.
    faulty_hull_lock<LockOptions{.consent = {.stamps_count = false}}>(
        "arrival-order", "hull-lock with a fault: takes the last message to come for the newest"),
    // FAULT: a GRANT counts for whatever request is open, even if it answers an earlier one.
    faulty_hull_lock<LockOptions{.consent = {.answers_name_epoch = false}}>(
        "stale-grant", "hull-lock with a fault: takes a grant for an earlier request as one for this request"),
    // FAULT: a second GRANT of the same AGV counts as that of another AGV.
    faulty_hull_lock<LockOptions{.consent = {.senders_count = false}}>(
        "counts-messages", "hull-lock with a fault: counts messages, not senders"),
    // FAULT: an AGV that was far away once is taken to be there still.
    faulty_hull_lock<LockOptions{.consent = {.proofs_age = false}}>(
        "ageless-proof", "hull-lock with a fault: ignores the age of a position"),
    // FAULT: an AGV is taken to have gone on as between its last two positions.
    faulty_hull_lock<LockOptions{.consent = {.places_spread = false}}>(
        "straight-on", "hull-lock with a fault: extrapolates positions"),
    // FAULT: an AGV whose way keeps clear need not have heard of the request.
    faulty_hull_lock<LockOptions{.consent = {.ways_are_heard = false}}>(
        "unheard-way", "hull-lock with a fault: counts on ways before its own has been heard"),
    // FAULT: after a restart, requests have the numbers of earlier requests once more.
    faulty_hull_lock<LockOptions{.consent = {.epochs_name_boot = false}}>(
        "forgets-boot", "hull-lock with a fault: numbers its requests without the boot"),
    // FAULT: the number of a request has eight bits.
    faulty_hull_lock<LockOptions{.consent = {.epochs_grow = false}}>(
        "wraps-at-256", "hull-lock with a fault: numbers its requests modulo 256"),
    // FAULT: an AGV that stands grants the floor under it.
    faulty_hull_lock<LockOptions{.grants = {.bodies_count = false}}>(
        "ignores-parked", "hull-lock with a fault: holds no floor while it stands"),
    // FAULT: after a restart at rest, an AGV grants everything until it knows its heading.
    faulty_hull_lock<LockOptions{.grants = {.unknown_place_defers = false}}>(
        "grants-at-boot", "hull-lock with a fault: grants everything right after a restart"),
    // FAULT: an AGV that granted one request grants all later requests of the same AGV.
    faulty_hull_lock<LockOptions{.grants = {.grants_name_epoch = false}}>(
        "grants-for-good", "hull-lock with a fault: grants all requests of an AGV once it has granted one"),
    // FAULT: 20 s after it locked, an AGV grants what it holds.
    faulty_hull_lock<LockOptions{.grants = {.locks_end_after_ns = 20 * kSecond_ns}}>(
        "lock-expires", "hull-lock with a fault: lets its lock end after 20 s"),
    // FAULT: a request that has granted a conflicting one goes on as if it had not.
    faulty_hull_lock<LockOptions{.grants = {.overtaken = Overtaken::GoesOn}}>(
        "overtaken-goes-on", "hull-lock with a fault: does not begin a new epoch after a grant"),
    // FAULT: a request that grants a conflicting one gives back the other AGV's grant, but begins no new epoch.
    faulty_hull_lock<LockOptions{.grants = {.overtaken = Overtaken::DropsThatGrant}}>(
        "overtaken-drops-grant", "hull-lock with a fault: gives back a grant instead of beginning a new epoch"),
    // FAULT: a request that grants a conflicting one begins a new epoch only if it has the other AGV's grant
    // already.
    faulty_hull_lock<LockOptions{.grants = {.overtaken = Overtaken::StepsBackIfGranted}}>(
        "overtaken-if-granted", "hull-lock with a fault: begins a new epoch only if it was granted"),
    // FAULT: of two demands of the same age, neither comes first.
    faulty_hull_lock<LockOptions{.progress = {.smaller_number_first = false}}>(
        "tie-without-number", "hull-lock with a fault: has no rule for demands of the same age"),
    // FAULT: a lane is released 2 s before its end.
    faulty_hull_lock<LockOptions{.holding = {.lanes_to_their_end = false}}>(
        "early-release", "hull-lock with a fault: releases a lane 2 s before its end"),
    // FAULT: a restarted AGV holds the station where it was, not the lane that it drives.
    faulty_hull_lock<LockOptions{.holding = {.lanes_over_restarts = false}}>(
        "restart-forgets-lane", "hull-lock with a fault: forgets at a restart what it drives"),
    // FAULT: a restarted AGV holds the lane that it drives, but not the turn before it.
    faulty_hull_lock<LockOptions{.holding = {.turns_over_restarts = false}}>(
        "restart-forgets-turn", "hull-lock with a fault: forgets at a restart that it turns"),
    // FAULT: an AGV that is out of order releases the lane on which it stopped.
    faulty_hull_lock<LockOptions{.holding = {.lanes_over_failures = false}}>(
        "failure-frees-lane", "hull-lock with a fault: releases its lane when it breaks down"),
    // FAULT: a REQUEST is never sent again.
    faulty_hull_lock<LockOptions{.progress = {.asks_again = false}}>("asks-once",
                                                                     "hull-lock with a fault: never repeats a request"),
    // FAULT: of two AGVs that request the same floor, each lets the other go first.
    faulty_hull_lock<LockOptions{.progress = {.order_is_common = false}}>(
        "both-step-back", "hull-lock with a fault: of two requests, each AGV lets the other go first"),
    // FAULT: an AGV never leaves a place that others need.
    faulty_hull_lock<LockOptions{.progress = {.makes_way = false}}>("never-makes-way",
                                                                    "hull-lock with a fault: makes way for nobody"),
    // FAULT: an AGV locks one lane at a time.
    faulty_hull_lock<LockOptions{.progress = {.whole_sections = false}}>(
        "lane-by-lane", "hull-lock with a fault: locks one lane at a time"),
};

}  // namespace

constinit const std::span<const fp_agent_type> kFaultyAgents = kTable;

}  // namespace fleetproof::agents
