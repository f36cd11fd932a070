#pragma once

#include "core/engine/actions.hpp"
#include "core/engine/activities.hpp"
#include "core/engine/agent_host.hpp"
#include "core/engine/agv_controller.hpp"
#include "core/engine/battery.hpp"
#include "core/engine/contacts.hpp"
#include "core/engine/declarations.hpp"
#include "core/engine/drives.hpp"
#include "core/engine/fault_desk.hpp"
#include "core/engine/halts.hpp"
#include "core/engine/messenger.hpp"
#include "core/engine/operator_desk.hpp"
#include "core/engine/position_sensor.hpp"
#include "core/engine/scanner.hpp"
#include "core/engine/timers.hpp"

namespace fleetproof {

// The parts of the engine, wired to each other. Each gets the ports that it needs and no more. The agents come last, so
// that they are destroyed while everything they may call is still there.
struct Parts {
  Parts(RunContext& run, const fp_agent_type& agent, const char* agent_config, const RunWatch& watch = {});
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
  FaultDesk faults;
  OperatorDesk operator_desk;
  Timers timers;
  Declarations declarations;
  AgvController controller;
  AgentHost agents;
};

}  // namespace fleetproof
