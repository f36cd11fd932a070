#include "core/agents/vocabulary.hpp"

namespace fleetproof::agents {
namespace {

constexpr Word kWords[] = {
    {"asks with", "the number of a request: 3.0 is the first attempt of the AGV's 3rd request, 3.1 the second one"},
    {"asks nobody", "its request is open, and no AGV that it asked still owes it an answer"},
    {"for", "the first and the last station of the way that it asks for; what it holds ends with the first"},
    {"answers", "the number of the request that it answers"},
    {"holds", "the way that is its own: where it stands or drives, until it has passed it"},
    {"of boot", "the number counts from a restart of the computer on: boot 1 is after the first one"},
    {"requesting", "it has asked for the next section of its way"},
    {"waiting", "it stands, and cannot go on yet"},
    {"out of order", "it is broken down, empty or stopped by a contact"},
    {"negotiation", "it asked the AGVs whose consent it needs"},
    {"unasked", "it took a way without asking: to its knowledge, nothing that others hold or ask for is near it"},
    {"newcomer", "it asked one more AGV for a request that is open"},
    {"deferred", "it answered a request with DEFER: not now"},
    {"joins", "in a divided fleet, it asked who else is in the zones of its way"},
    {"grant-lost", "it was asked again for what it granted; a follower: it lacks the steps before those of a GRANT"},
    {"retransmission", "it asked again, because no answer came"},
    {"overtaken", "it granted a request that comes first, and has to ask that AGV again for its own"},
    {"late-grant", "a GRANT, or a STATE that repeats one, was for another request or attempt than its open one"},
    {"silence-taken-for-consent", "it took silence for a GRANT"},
    {"restarted", "its computer has started anew"},
    {"makes-way", "it has nothing to do, and leaves a place that another AGV asks for"},
    {"another-way-round", "an AGV holds what it asks for, and it asks for another way"},
    {"retreat", "it asks for a way back, to let others pass"},
    {"drives-to-charger", "its battery is low"},
    {"number-wrapped", "its requests began again with number 1"},
    {"steps", "numbered actions that a zone-server grants to a follower: lanes to drive, loads to pick and drop"},
    {"learning", "the zone-server does not know yet where each AGV stands, and grants nothing"},
    {"finding its place", "since a restart, the follower waits until it surely rests"},
    {"grant", "the zone-server granted steps"},
    {"server-restarted", "the follower heard that its zone-server has started anew, without its book"},
    {"recalled", "the zone-server has started anew, and had its book on its disk"},
    {"set-down-in-the-way", "an AGV was set down on floor that others hold: it gets no steps before they have passed"},
    {"grant-of-another-way", "the follower got a GRANT from before a restart of the server, or of its own computer"},
};

}  // namespace

std::span<const Word> vocabulary() { return kWords; }

}  // namespace fleetproof::agents
