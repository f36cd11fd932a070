// What an AGV claims: the path that it holds, its request, and the way that it announces.
#pragma once

#include <array>
#include <cstdint>

#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// The way that an AGV announces from the end of its held path: first what it requests, then where it means to go on.
// Every message contains it, so another AGV knows of a lane what its newest message said. Instants are the stamps of
// messages.
class AnnouncedWay {
 public:
  const Path& path() const { return path_; }

  // From now on, messages contain this way; `first_ms` is the first stamp of which this is true of each message.
  // Lanes with which the former way began, too, have been announced since then.
  void replace(const Path& way, std::uint32_t first_ms);
  // The first lanes are held now. Requires: the way has so many.
  void shorten(const MapView& map, std::uint32_t lanes);
  // Each message with this stamp or a later one contains the first `lanes` of the way. Requires: the way has so many.
  std::uint32_t since_ms(std::uint32_t lanes) const { return lanes == 0 ? 0 : since_ms_[lanes - 1]; }

 private:
  Path path_;
  std::array<std::uint32_t, kPathLanesMax> since_ms_{};  // by lane; never less than that of the lane before
};

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
