#pragma once

#include <optional>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// The laser scanner of each AGV: it looks every reaction time while the AGV drives or stands because of it, stops the
// AGV when a body stands in its protective field, and lets it go on some time after the field is clear.
class Scanner {
 public:
  struct Ports {
    Contacts& contacts;
    HaltsPort halts;
    OperatorActions& operator_actions;
  };
  Scanner(RunContext& run, const Ports& ports);

  void drive_begins(AgvId agv);
  // The event. Nothing happens if another drive has begun since.
  void looks(AgvId agv, std::uint64_t stamp);
  // The operator mutes the field until it is clear.
  void set_muted(AgvId agv, bool muted) { agv_states_[agv.index()].muted = muted; }

 private:
  struct AgvState {
    std::uint64_t stamp = 0;
    bool muted = false;
    bool backward = false;  // the drive that it watches, or has stopped
    // The length of the field when it stopped the AGV, and where that was: so much has to be clear again.
    double field_m = 0.0;
    Vec2 field_from_m = Vec2::Zero();
    std::optional<SimTime> clear_since;
  };
  double field_length_m(AgvId agv) const;
  std::optional<EntityId> intruder(AgvId agv, double length_m) const;
  void stop(AgvId agv, EntityId body);
  void wait_while_clear(AgvId agv);

  RunContext& run_;
  Ports ports_;
  std::vector<AgvState> agv_states_;  // by AGV
};

}  // namespace fleetproof
