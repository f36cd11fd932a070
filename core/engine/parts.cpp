#include "core/engine/parts.hpp"

namespace fleetproof {

// A port is made from a part that may not have been constructed yet: it keeps the address and calls nothing.
Parts::Parts(RunContext& run, const fp_agent_type& agent, const char* agent_config, const RunWatch& watch)
    : battery(run, {HaltsPort(halts), OperatorDeskPort(operator_desk)}),
      contacts(run, {ActionsPort(actions), OperatorDeskPort(operator_desk)}),
      sensor(run),
      scanner(run, {ContactsPort(contacts), HaltsPort(halts), OperatorDeskPort(operator_desk)}),
      messenger(run, AgentHostPort(agents)),
      activities(run, {BatteryPort(battery), ContactsPort(contacts), FaultDeskPort(faults), MessengerPort(messenger),
                       PositionSensorPort(sensor)}),
      drives(run, {ActivitiesPort(activities), ScannerPort(scanner)}),
      actions(run, {ActivitiesPort(activities), AgentHostPort(agents), BatteryPort(battery), DrivesPort(drives)}),
      halts(run, ActionsPort(actions)),
      faults(run, {ActionsPort(actions), AgentHostPort(agents), ContactsPort(contacts), HaltsPort(halts)}),
      operator_desk(run, {ActionsPort(actions), AgentHostPort(agents), BatteryPort(battery), ContactsPort(contacts),
                          FaultDeskPort(faults), HaltsPort(halts), MessengerPort(messenger), PositionSensorPort(sensor),
                          ScannerPort(scanner)}),
      timers(run, AgentHostPort(agents)),
      declarations(run),
      controller(run, {ActionsPort(actions), BatteryPort(battery), DeclarationsPort(declarations), HaltsPort(halts),
                       MessengerPort(messenger), PositionSensorPort(sensor), TimersPort(timers)}),
      agents(run, {ActionsPort(actions), AgvControllerPort(controller), TimersPort(timers)}, agent, agent_config,
             watch) {}

}  // namespace fleetproof
