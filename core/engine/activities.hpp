#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// Begins, continues and ends the activities of AGVs. Whatever changes with an activity changes here: the AGV's piece in
// the world, the load that is handed over, the battery's books, the predicted touches and the trace.
class Activities {
 public:
  struct Ports {
    BatteryPort battery;
    Contacts& contacts;
    FaultInjector& faults;
    MessengerPort messenger;
    PositionSensorPort sensor;
  };
  Activities(RunContext& run, const Ports& ports);

  // Events of kind ActivityEnds carry the stamp of the activity that they end; false for one that has changed since.
  bool is_current(AgvId agv, std::uint64_t stamp) const {
    return stamp == stamps_[agv.index()] && run_.status(agv).activity.has_value();
  }

  // `subject` is the station, segment or load that the trace names.
  void begin(AgvId agv, const Activity& activity, std::uint64_t subject);
  // A drive or a turn, in which the AGV's body moves as `piece` says.
  void begin_moving(AgvId agv, ActivityKind kind, const Piece& piece, std::uint64_t subject);
  // The drive or turn under way goes on in another piece.
  void continue_with(AgvId agv, const Piece& piece);
  // Leaves the state behind that the activity has reached now. A transfer of a load takes place only if the activity
  // ends as planned.
  void end(AgvId agv, bool as_planned);
  // The end of a turn as planned: with exactly this heading.
  void end_turn_at(AgvId agv, const Vec2& heading);
  // The end of a drive that the next drive follows without a stop.
  void end_rolling(AgvId agv);
  void stand(AgvId agv, const Pose& pose);

 private:
  Activity take_off(AgvId agv);
  void announce_end(AgvId agv, ActivityKind kind, bool as_planned);
  void set_piece(AgvId agv, const Piece& piece);
  void transfer(AgvId agv, const ContainmentEvolution& evolution);

  RunContext& run_;
  Ports ports_;
  std::vector<std::uint64_t> stamps_;  // by AGV
};

}  // namespace fleetproof
