#pragma once

#include <optional>
#include <vector>

#include "core/engine/disks.hpp"
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
    Disks& disks;
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
    AgvId agv{};             // that it holds
    bool came = false;       // of a fault that counts from a pick: it has been set
  };
  // Of an AGV: a computer has nothing that could brake.
  bool holds(EntityId agv, Fault::Kind kind) const { return holds_agv(kind) && run_.scenario.is_agv(agv); }
  // Whether the fault counts from the pick of this transport.
  bool is_of(const Fault& fault, TransportId transport) const {
    return fault.transport && fault.agv == run_.orders.agv_of(transport) &&
           *fault.transport == run_.orders.place_of(transport);
  }
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
