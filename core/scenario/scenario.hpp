#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/random.hpp"
#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/scenario/computers.hpp"
#include "core/scenario/faults.hpp"
#include "core/scenario/layout.hpp"
#include "core/scenario/radio_setup.hpp"
#include "core/scenario/vehicle_type.hpp"

namespace fleetproof {

struct TransportOrder {
  StationId from, to;
  Duration release{};
  // When it is withdrawn. The transport is over then, unless an AGV has taken its load up before.
  Duration withdrawn = kLongestDuration;
};

// A controller call at a fixed time, for the `scripted` agent.
struct ScriptedCall {
  enum class Action : std::uint8_t { Move, Pick, Drop, Park, Charge };
  Duration at{};
  Action action = Action::Move;
  SegmentId segment;  // invalid, but not of a move: the AGV does not drive first
  bool backward = false;
};
constexpr const char* name_of(ScriptedCall::Action action) {
  switch (action) {
    case ScriptedCall::Action::Move:
      return "move";
    case ScriptedCall::Action::Pick:
      return "pick";
    case ScriptedCall::Action::Drop:
      return "drop";
    case ScriptedCall::Action::Park:
      return "park";
    case ScriptedCall::Action::Charge:
      return "charge";
  }
  return kNoWord;
}

// How wrong the clock and the position are that the agent of an AGV sees. They do not change what happens.
struct SensingSetup {
  double clock_offset_s = 0.0;    // how far the clock is ahead of the true time; never below 0
  double clock_drift_ppm = 0.0;   // how much too fast the clock runs
  double position_error_m = 0.0;  // largest error of each coordinate; another error every 0.1 s
  double position_late_s = 0.0;   // the agent sees the position of this long ago

  friend bool operator==(const SensingSetup&, const SensingSetup&) = default;
};

struct AgvSetup {
  std::string name;
  std::uint32_t type = 0;  // index into vehicle_types
  StationId start;
  Vec2 heading = Vec2::UnitX();
  double battery = 1.0;
  SensingSetup sensing;
  std::vector<TransportOrder> transports;  // the agent receives each order at its release
  std::vector<ScriptedCall> script;
  // Under this number everything random about the AGV is drawn. Without it, its place in the fleet is the number. An
  // AGV that keeps its number keeps its draws when others are taken out of the fleet.
  std::optional<std::uint32_t> draws_as;
};

// A body that stands on the floor. If it appears later, it waits until its place is clear of every other body by the
// safety distance plus 5 cm. This is tried every second, until it leaves.
inline constexpr double kAppearsClear_m = 0.05;
struct ObstacleSetup {
  std::string name;
  Footprint footprint;
  Pose pose;
  Duration appears{};
  Duration leaves = kLongestDuration;
};

struct AgentClockSetup {
  double call_cost_s = 0.0;  // simulated time that every controller call takes
};

// Two kinds of bodies: names of vehicle types, or kAnyObstacle.
struct ExemptPair {
  std::string one, other;

  friend bool operator==(const ExemptPair&, const ExemptPair&) = default;
};
inline constexpr std::string_view kAnyObstacle = "obstacle";  // every body but AGVs: obstacles and fallen loads

struct LawSetup {
  double safety_distance_m = 0.10;
  double snapshot_s = 0.0025;  // granularity of the published laws (400 a second)
  double reaction_s = 10.0;    // normal-operation: an agent may leave safe mode this much later than it could
  double min_transports_per_agv_hour = 0.0;  // normal-operation: a floor for the throughput of a run; 0: none
  Purposes exempt_purposes;  // safety-distance: two bodies may be close to each other if both stay within
                             // exempt_radius_m of one station with such a purpose
  double exempt_radius_m = 0.0;
  std::vector<ExemptPair> exempt_pairs;  // safety-distance: two such bodies may be close to each other anywhere
  std::vector<std::string> leave_out;    // a saved case: laws of the default set that its campaign did not run
};

// What a saved case is known to do. It changes nothing.
struct ExpectedOutcome {
  std::string failure;       // how it fails, in the words of `shrink`
  std::uint64_t digest = 0;  // of its trace

  friend bool operator==(const ExpectedOutcome&, const ExpectedOutcome&) = default;
};

// How long a run lasts, and after how long without progress it is stuck, if nothing else is said.
inline constexpr Duration kUsualHorizon = std::chrono::seconds(600), kUsualPatience = std::chrono::seconds(120);

// Everything that one simulation needs, as plain data.
struct Scenario {
  std::string name;
  std::shared_ptr<const LogicalMap> map;  // shared: the runs on one layout read the same curves
  std::vector<VehicleType> vehicle_types{VehicleType{}};
  std::vector<AgvSetup> agvs;
  // Transports that no AGV is given. Each is released to the computers, or to all AGVs if there are no computers; the
  // AGV that takes the load up carries it out.
  std::vector<TransportOrder> open_orders;
  std::vector<ComputerSetup> computers;
  WireSetup wire;
  std::vector<ObstacleSetup> obstacles;
  std::vector<Fault> faults;
  ScannerSetup scanner;
  OperatorSetup operator_help;
  RadioSetup radio;
  std::vector<GivenDelivery>
      deliveries;  // of single messages, over what the radio draws; in any order, each message once
  AgentClockSetup agent_clock;
  LawSetup law;
  bool contact_stops = true;  // bodies that touch stand still afterwards
  Duration horizon = kUsualHorizon, stuck_after = kUsualPatience;
  std::uint64_t seed = 0;  // of the world: keys of radio and agent randomness derive from it
  std::vector<StreamSeed>
      stream_seeds;  // streams drawn from another seed, each at most once, in the order of kRunStreams
  // The control software of the fleet and its parameters, for scenario files. Campaigns combine every world with
  // several agents and leave both empty.
  std::string agent, agent_config;
  ExpectedOutcome expected;

  std::uint64_t seed_of(Stream stream) const;  // `stream` is one of kRunStreams
  const VehicleType& type_of(const AgvSetup& agv) const { return vehicle_types[agv.type]; }
  // Ids of entities: AGVs, computers, obstacles, then the loads that fall, in the order of their faults. The first two
  // are the participants: control software runs there.
  std::size_t participant_count() const { return agvs.size() + computers.size(); }
  bool is_agv(EntityId id) const { return id.index() < agvs.size(); }
  bool is_computer(EntityId id) const { return !is_agv(id) && id.index() < participant_count(); }
  // Whether a wire connects the two.
  bool are_wired(EntityId a, EntityId b) const { return is_computer(a) && is_computer(b); }
  EntityId first_computer() const { return EntityId{agvs.size()}; }
  EntityId first_obstacle() const { return EntityId{participant_count()}; }
  EntityId first_fallen_load() const { return EntityId{participant_count() + obstacles.size()}; }
  std::size_t entity_count() const;
  // Requires, of these: such an id.
  const ComputerSetup& computer(EntityId id) const { return computers[id.index() - agvs.size()]; }
  const ObstacleSetup& obstacle(EntityId id) const { return obstacles[id.index() - participant_count()]; }
  const std::string& name_of(EntityId participant) const {
    return is_agv(participant) ? agvs[participant.index()].name : computer(participant).name;
  }
};

}  // namespace fleetproof
