#pragma once

#include <optional>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// Actions of AGVs: how a controller call becomes a turn, a drive and a stay, which action is queued behind it, and how
// each ends or is cut short.
class Actions {
 public:
  struct Ports {
    ActivitiesPort activities;
    AgentHostPort agents;
    BatteryPort battery;
    Drives& drives;
  };
  Actions(RunContext& run, const Ports& ports);

  // Whether the controller takes this call; if not, the refusal is traced. Requires after true: `begin` or
  // `withdraw_accepted`, before which no other call is taken.
  // `load`: the load that a pick is to take, if the agent has named one.
  bool accept(AgvId agv, fp_call call, std::uint32_t segment, LoadId load = {});
  // The accepted call takes effect.
  void begin(AgvId agv, fp_call call, std::uint32_t segment, LoadId load = {});
  // The accepted call, if there is one, never takes effect: the agent is gone.
  void withdraw_accepted(AgvId agv);
  void activity_ends(AgvId agv);

  fp_action doing(AgvId agv) const;
  LanesAhead lanes(AgvId agv) const;

  // A first halt holds the AGV, or one that holds more than its motion.
  void brake(AgvId agv);
  // The last halt is over, or the last one that held more than motion.
  void go_on(AgvId agv);
  // The AGV's load has fallen off.
  void reshape(AgvId agv);
  // After a contact. False if the AGV was out of order already.
  bool stop_for_good(AgvId agv);
  // The operator has set it down at a station: it obeys again.
  void put_back(AgvId agv, StationId station);

 private:
  // An action. What is left of it after the activity under way: drive, settle, dock, stay.
  struct Plan {
    fp_call call = FP_CALL_MOVE;
    const Lane* lane = nullptr;
    bool drive_due = false, settle_due = false, dock_due = false, stay_due = false;
    double way_m = 0.0;            // along the lane: where a drive goes on that a halt has cut short
    bool turn_ends_early = false;  // the turn under way brakes before the lane's heading
    LoadId load{};                 // named for a pick
  };
  // An action accepted while the AGV was still on its way to the station at which it begins.
  struct NextAction {
    fp_call call = FP_CALL_MOVE;
    const Lane* lane = nullptr;
    LoadId load{};
  };
  struct AgvState {
    bool acting = false;     // an action is under way
    bool committed = false;  // or one has been accepted
    bool accepted = false;   // one has been accepted and has not taken effect
    bool waits = false;      // the plan goes on when the halts are over
    Plan plan;
    std::optional<NextAction> next;
    fp_action doing = FP_IDLE;
    std::uint32_t transfers = 0;  // begun in this run: they number the draws of the motion stream
  };

  bool is_possible(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const;
  void begin_plan(AgvId agv, const NextAction& action, double entry_mps);
  void continue_plan(AgvId agv, double entry_mps);
  void finish(AgvId agv, double speed_mps);
  void turn_or_drive(AgvId agv, double entry_mps);
  void brake_turn(AgvId agv);
  void begin_settling(AgvId agv);
  void begin_docking(AgvId agv);
  void begin_stay(AgvId agv);
  void begin_transfer(AgvId agv, ActivityKind kind);
  void begin_activity(AgvId agv, const Activity& activity, std::uint64_t subject);
  void leg_ends(AgvId agv);
  void take_next(AgvId agv, fp_call call, std::uint32_t segment, LoadId load);
  void tell_done(AgvId agv, fp_result result);

  RunContext& run_;
  Ports ports_;
  std::vector<AgvState> agv_states_;  // by AGV
};

}  // namespace fleetproof
