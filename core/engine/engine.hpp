// The event loop of one run, and the parts that it hands events to.
#pragma once

#include <memory>
#include <span>

#include "core/engine/actions.hpp"
#include "core/engine/activities.hpp"
#include "core/engine/agent_host.hpp"
#include "core/engine/agv_controller.hpp"
#include "core/engine/battery.hpp"
#include "core/engine/contacts.hpp"
#include "core/engine/declarations.hpp"
#include "core/engine/disks.hpp"
#include "core/engine/drives.hpp"
#include "core/engine/fault_injector.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/halts.hpp"
#include "core/engine/messenger.hpp"
#include "core/engine/operator_actions.hpp"
#include "core/engine/position_sensor.hpp"
#include "core/engine/run_context.hpp"
#include "core/engine/scanner.hpp"
#include "core/engine/timers.hpp"

namespace fleetproof {

// The parts of the engine, wired to each other. Each gets the parts and ports that it needs and no more. The agents
// come last, so that they are destroyed while everything they may call is still there.
struct Parts {
  Parts(RunContext& run, const FleetSoftware& software, const RunWatch& watch = {});
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  Battery battery;
  Contacts contacts;
  PositionSensor sensor;
  Scanner scanner;
  Messenger messenger;
  Activities activities;
  Drives drives;
  Actions actions;
  Halts halts;
  Disks disks;
  FaultInjector faults;
  OperatorActions operator_actions;
  Timers timers;
  Declarations declarations;
  AgvController controller;
  AgentHost agents;
};

// The event loop of one run: takes the next event from the queue, sets the clock, and hands the event to the part that
// its kind belongs to. A local variable of simulate(); thousands can live at once.
class Engine {
 public:
  Engine(const Scenario& scenario, const FleetSoftware& software, std::span<const std::unique_ptr<Law>> laws,
         TraceSink* sink, const RunWatch& watch = {});

  // From the start to the horizon. Call it once. Throws RunAbandoned if the watch says so.
  void run();
  // Adds up the counters. Requires: `run` has returned. Call it once: the results of the laws move into the outcome.
  Outcome finish();

 private:
  void start();
  void announce_orders(AgvId agv, const std::vector<TransportOrder>& orders);
  void goes_on_until(SimTime at);
  void handle(const Event& event);
  bool is_stuck() const;
  void file_findings(Outcome& outcome) const;

  std::span<const std::unique_ptr<Law>> laws_;
  const std::atomic<bool>* abandon_;
  RunContext run_;
  Parts parts_;
};

}  // namespace fleetproof
