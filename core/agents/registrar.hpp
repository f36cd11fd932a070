#pragma once

#include <cstdint>

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

}  // namespace fleetproof::agents
