#pragma once

#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// The operator: when it is called, when it comes, and what it does then. What it may do stands at OperatorSetup.
class OperatorDesk {
 public:
  struct Ports {
    ActionsPort actions;
    AgentHostPort agents;
    BatteryPort battery;
    ContactsPort contacts;
    FaultDeskPort faults;
    HaltsPort halts;
    MessengerPort messenger;
    PositionSensorPort sensor;
    ScannerPort scanner;
  };
  OperatorDesk(RunContext& run, const Ports& ports);

  // For a jam or an empty battery, `halt` identifies the halt that it caused. If that halt is over when the operator
  // arrives, nothing happens.
  void call(AgvId agv, Assist what, std::uint64_t halt);
  void comes(AgvId agv, Assist what, std::uint64_t stamp);
  // Looks for a standstill, and does so again every second from then on.
  void looks();
  // The AGV has been taken off the floor. Sets it down again, or tries again in a second.
  void look_for_place(AgvId agv);

 private:
  Duration until_help_comes(AgvId agv, std::uint32_t topic, std::uint32_t number) const;
  void assisted(AgvId agv, Assist what);
  void help_with_halt(AgvId agv, Assist what, std::uint64_t halt);
  void change_battery(AgvId agv);
  void take_off_floor(AgvId agv);
  void set_down(AgvId agv, StationId station);
  bool is_on_the_way(const OrientedRectangle& place, double margin_m) const;
  bool passes(AgvId agv, const Lane* lane, const Box& place, double margin_m) const;
  bool has_open_transport(AgvId agv) const;
  bool stands_still() const;
  AgvId longest_idle() const;
  std::uint64_t standstill_began_ns() const;
  void help_at_standstill(AgvId agv, std::uint64_t began_ns);

  RunContext& run_;
  Ports ports_;
  std::vector<std::uint32_t> calls_;  // by AGV: for something else than a standstill
  SimTime still_since_ = kStart;      // when the operator last saw work under way, or restarted an agent
  bool standstill_called_ = false;
  std::uint32_t standstills_ = 0;  // for which the operator was called
};

}  // namespace fleetproof
