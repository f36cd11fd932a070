#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/motion/activity.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// Why an AGV brakes and stands, wherever it is.
struct Halt {
  enum class Reason : std::uint8_t {
    ProtectiveStop,
    Scanner,
    Breakdown,
    EmptyBattery,
    Agent  // holds only motion: what the AGV does at rest goes on
  } reason = Reason::ProtectiveStop;
  std::uint64_t number = 0;  // unique per AGV
  bool out_of_order() const { return reason == Reason::Breakdown || reason == Reason::EmptyBattery; }
};

// What every part may read about an AGV. Only the part named above a group writes it; all other state of an AGV is
// private to one part.
struct AgvStatus {
  // Actions.
  StationId station;                 // where it stands, or the last station it left
  bool out_of_order = false;         // for good, or until the operator has set it down at a station
  const Lane* stopped_on = nullptr;  // if out of order: the lane on which it stands; null: it stands at its station

  // Activities.
  std::optional<Activity> activity;

  // Halts. The AGV stands while the list is not empty.
  std::vector<Halt> halts;

  // Whichever part sees progress: work began or ended, a halt ended that was not the agent's, or the operator set the
  // AGV down or restarted its agent.
  SimTime last_progress = kStart;

  bool is_driving() const { return activity && activity->kind == ActivityKind::Drive; }
  // By something else than its agent.
  bool is_held() const {
    return std::ranges::any_of(halts, [](const Halt& halt) { return halt.reason != Halt::Reason::Agent; });
  }
  bool is_held_by(Halt::Reason reason) const { return std::ranges::find(halts, reason, &Halt::reason) != halts.end(); }
};

}  // namespace fleetproof
