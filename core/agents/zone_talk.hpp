// The talk about zones in a divided fleet: an AGV applies for zones, and others show it who is there.
#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/controller.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/lock_claim.hpp"
#include "core/agents/lock_messages.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/membership.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/zone_map.hpp"

namespace fleetproof::agents {

// Keeps the rolls of zones: who announces them, as far as is known. After a start or a restart it knows nothing. It
// shows no roll before it has heard from every other AGV of the fleet since then.
class Registrar {
 public:
  // Requires: the neighbours outlive the object.
  explicit Registrar(Neighbours& neighbours) : neighbours_(neighbours) {}

  // True once it has heard from every AGV.
  bool is_ready();
  // The roll of these zones for `applicant`, or the part from an AGV on that has room.
  void fill_in(Roll& roll, const ZoneSet& zones, std::uint32_t applicant, std::uint32_t from) const;
  // Calls `f(agv)` for each AGV from which it has not heard.
  template <class F>
  void for_each_missing(F f) const {
    for (std::uint32_t agv = heard_from_; agv < neighbours_.fleet_count(); ++agv) {
      if (!has_heard_from(agv)) f(agv);
    }
  }

 private:
  bool has_heard_from(std::uint32_t agv) const { return agv == neighbours_.self() || neighbours_.is_fresh(agv); }

  Neighbours& neighbours_;
  std::uint32_t heard_from_ = 0;  // from all AGVs before this one
};

// How an AGV of a fleet that is divided into zones knows whom it may meet: what it says and hears about zones.
class ZoneTalk {
 public:
  // Requires: what is referred to outlives the object.
  ZoneTalk(const MapView& map, const HullGeometry& geometry, Neighbours& neighbours, Controller& controller,
           const Claim& claim, LockMessages& messages)
      : neighbours_(neighbours),
        controller_(controller),
        claim_(claim),
        messages_(messages),
        map_(map, geometry, neighbours.fleet_count(), neighbours.claim_limit_m()),
        membership_(map_, neighbours),
        registrar_(neighbours) {}

  // The claim has another request. False if it has too many zones, which it never has.
  bool find_zones_of_request();
  // The claim is another one.
  void announce();
  // Whether it is a member of all zones of the request.
  bool is_member_there() const { return membership_.is_member_of_all(of_request_); }
  // Whether the newest message of that AGV announces no zone of the request.
  bool is_elsewhere(const Neighbour& n) const { return !n.zones.meets(of_request_); }

  // Requires: the message has been noted.
  void hear(std::uint32_t sender, const Message& message);
  // Whether something has come up.
  bool has_news() const {
    return membership_.has_news() || !applicants_.empty() || !to_answer_.empty() || !to_tell_.empty();
  }
  // Says what has come up, and if it is time to `repeat`, what may have been lost.
  void talk(bool repeat);

 private:
  struct Applicant {
    std::uint32_t agv;
    ZoneSet zones;
    std::uint32_t from;
  };

  void apply(const Membership::Due& due);
  void send_roll(const Applicant& applicant);
  void take_own_roll(const Membership::Due& due);

  Neighbours& neighbours_;
  Controller& controller_;
  const Claim& claim_;
  LockMessages& messages_;
  ZoneMap map_;
  Membership membership_;
  Registrar registrar_;
  ZoneSet of_request_;
  std::vector<Applicant> applicants_;     // to whom it owes a roll
  std::vector<std::uint32_t> to_answer_;  // AGVs that wait for an acknowledgement
  std::vector<std::uint32_t> to_tell_;    // AGVs whose zones this one has left
  std::vector<Membership::Due> due_;
};

}  // namespace fleetproof::agents
