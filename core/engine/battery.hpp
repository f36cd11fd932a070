#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// The batteries of the AGVs: linear in the way driven and in time. Each activity settles the account of its AGV, and
// the instant at which a battery runs empty is predicted within the activity under way.
class Battery {
 public:
  struct Ports {
    HaltsPort halts;
    OperatorActions& operator_actions;
  };
  Battery(RunContext& run, const Ports& ports);

  // Books what the AGV has used and got until now. Call this before the AGV's activity changes.
  void settle(AgvId agv);
  // Predicts anew. Call this after an activity has begun, changed or ended.
  void activity_changed(AgvId agv, bool drive_begins);
  void predict_empty(AgvId agv);
  void runs_empty(AgvId agv, std::uint64_t stamp);

  double level(AgvId agv) const;  // 0 .. 1
  // As of the last settling.
  bool is_out(AgvId agv) const { return agv_states_[agv.index()].out || agv_states_[agv.index()].level <= 0.0; }
  // The operator changes the battery for one with this level.
  void change(AgvId agv, double level);

  // At the end of the run: settles all accounts and adds them to the counters.
  void settle_accounts();

 private:
  // The energy used, in shares of a full battery.
  struct EnergyUse {
    double driven = 0.0, idled = 0.0, charged = 0.0;
  };
  struct AgvState {
    double level = 1.0;  // as of `at`
    SimTime at = kStart;
    double way_m = 0.0;  // along the drive under way, as of `at`
    double driven_m = 0.0;
    EnergyUse used;
    bool out = false;         // empty, until the operator has changed it
    std::uint64_t stamp = 0;  // of the prediction that holds
  };
  EnergyUse use_until(AgvId agv, SimTime t) const;

  RunContext& run_;
  Ports ports_;
  std::vector<AgvState> agv_states_;  // by AGV
};

}  // namespace fleetproof
