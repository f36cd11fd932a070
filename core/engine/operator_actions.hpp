// The operator: when it is called, when it comes, and where it sets an AGV down.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/scenario/lane_rules.hpp"

namespace fleetproof {

// Where an AGV that has been taken off the floor may be set down again.
struct RecoveryPlace {
  StationId station;
  Pose pose;
};

// The first place that suits, in order of preference; none if no place does. The first place of all is the station at
// which the AGV stood, with its heading there; if the AGV stood on a lane (`stopped_on`; null: on none), it is the end
// of that lane. The other agents expect the AGV at this place. Then come all stations to which lanes lead from there,
// by length of the way; equals by number. The operator pushes the AGV, so that no permission counts on the way. The
// heading is the one that the station demands, otherwise the one with which the AGV would have arrived. Places with
// lanes are left out if the rules let such an AGV drive off by none. It seeks no farther than it has to: most AGVs are
// set down near where they stood.
std::optional<RecoveryPlace> recovery_place(const LaneRules& rules, StationId station, const Lane* stopped_on,
                                            const Pose& stood, const std::function<bool(const RecoveryPlace&)>& suits);

// The operator: when it is called, when it comes, and what it does then. What it may do stands at OperatorSetup.
class OperatorActions {
 public:
  struct Ports {
    ActionsPort actions;
    AgentHostPort agents;
    BatteryPort battery;
    Contacts& contacts;
    FaultInjector& faults;
    HaltsPort halts;
    MessengerPort messenger;
    PositionSensorPort sensor;
    Scanner& scanner;
  };
  OperatorActions(RunContext& run, const Ports& ports);

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
  bool may_have_work(AgvId agv) const;
  bool stands_still() const;
  AgvId longest_idle() const;
  EntityId to_restart() const;
  std::uint64_t standstill_began_ns() const;
  void help_at_standstill(EntityId first, std::uint64_t began_ns);
  void restart(EntityId participant);

  RunContext& run_;
  Ports ports_;
  std::vector<std::uint32_t> calls_;  // by AGV: for something else than a standstill
  SimTime still_since_ = kStart;      // when the operator last saw work under way, or restarted an agent
  bool standstill_called_ = false;
  bool computers_restarted_ = false;  // since work was last under way
  std::uint32_t standstills_ = 0;     // for which the operator was called
};

}  // namespace fleetproof
