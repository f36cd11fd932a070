#pragma once

#include <cstdint>

#include "core/agents/announced_way.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// What an AGV holds and requests, and how far the request has got with another AGV: what its messages say.
struct Claim {
  Path held;
  bool knows_place = true;  // false: since a restart, the AGV does not know what it covers
  AnnouncedWay way;         // from the end of the held path; begins with the request
  bool requesting = false;
  Path request;
  std::int64_t demand_ns = 0;  // since when the AGV has wanted to go on
  Epoch epoch = 0;             // of the newest request
  bool grants_name_epoch = true;

  // Its own request.
  bool is_asked(const Neighbour& n) const { return requesting && request_of(n.asked_epoch) == epoch; }
  bool has_consent(const Neighbour& n) const { return is_asked(n) && n.granted_us_epoch == n.asked_epoch; }
  bool has_deferred(const Neighbour& n) const {
    return is_asked(n) && !has_consent(n) && n.deferred_us_epoch == n.asked_epoch;
  }
  // Whether this epoch has asked it and got no answer.
  bool is_unanswered(const Neighbour& n) const {
    return is_asked(n) && !has_consent(n) && n.deferred_us_epoch != n.asked_epoch;
  }
  // What a REQUEST says to it.
  Asked::Entry entry_for(std::uint32_t agv, const Neighbour& n) const {
    return {agv, static_cast<std::uint32_t>(n.asked_epoch - epoch)};
  }

  // The request of the other AGV.
  bool has_granted(const Neighbour& n) const {
    return grants_name_epoch ? n.granted_epoch == n.request_epoch : n.granted_epoch > 0;
  }
  bool owes_answer(const Neighbour& n) const {
    return n.request_is_open() && n.asks_us && (has_granted(n) || n.deferred_epoch == n.request_epoch);
  }
};

}  // namespace fleetproof::agents
