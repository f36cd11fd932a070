#pragma once

#include <optional>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// What goes wrong at times that the scenario fixes: the faults of AGVs, and bodies that appear on the floor and leave
// it.
class FaultInjector {
 public:
  struct Ports {
    ActionsPort actions;
    AgentHostPort agents;
    Contacts& contacts;
    HaltsPort halts;
  };
  FaultInjector(RunContext& run, const Ports& ports);

  // Before the run: sets the events of all faults and bodies.
  void schedule();
  // Faults that count from the time at which a load is taken up.
  void load_taken_up(AgvId agv, TransportId transport);
  // `number`: of the fault in the scenario.
  void strikes(AgvId agv, std::uint64_t number);
  void ends(AgvId agv, std::uint64_t number);
  // Ends early what holds this AGV.
  void end_halts_of(AgvId agv);

  void obstacle_appears(EntityId body);
  // An obstacle or a fallen load.
  void body_leaves(EntityId body);

 private:
  struct FaultState {
    std::uint64_t halt = 0;  // that the fault caused, while it lasts
    bool came = false;       // of a fault that counts from a pick: it has been set
  };
  // Of an AGV: a computer has nothing that could brake.
  bool holds(const Fault& fault) const { return holds_agv(fault.kind) && run_.scenario.is_agv(fault.agv); }
  void halt_ends(AgvId agv, std::uint64_t number);
  // Absent: the fault strikes. A load that can fall falls.
  std::optional<Denial> denial_of(AgvId agv, std::uint64_t number);
  std::optional<Denial> load_drops(AgvId agv, std::uint64_t number);
  EntityId fallen_body(std::uint64_t number) const;

  RunContext& run_;
  Ports ports_;
  std::vector<FaultState> fault_states_;  // by fault
};

}  // namespace fleetproof
