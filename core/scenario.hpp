#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/rectangle.hpp"
#include "core/layout.hpp"
#include "core/motion_profile.hpp"
#include "core/sim_time.hpp"
#include "core/strong_id.hpp"

namespace fleetproof {

// A kind of AGV. `turn` is in radians where MotionLimits says metres.
struct VehicleType {
  std::string name = "pallet-agv";
  Footprint footprint;
  MotionLimits drive;
  MotionLimits turn{.speed_mps = 1.0, .acceleration_mps2 = 1.0, .deceleration_mps2 = 1.0};
  double battery_per_m = 1.0 / 20000.0;        // share of a full battery
  double charge_per_s = 1.0 / 3600.0;
  double pick_s = 5.0, drop_s = 5.0;
};

struct TransportOrder {
  StationId from, to;
  Duration release{};
};

// A controller call at a fixed time, for the `scripted` agent.
struct ScriptedCall {
  enum class Action : std::uint8_t { Move, Pick, Drop, Park, Charge };
  Duration at{};
  Action action = Action::Move;
  SegmentId segment;
};

struct AgvSetup {
  std::string name;
  std::uint32_t type = 0;              // index into vehicle_types
  StationId start;
  Vec2 heading = Vec2::UnitX();
  double battery = 1.0;
  std::vector<TransportOrder> transports;  // assigned by the scenario; the agent is told at release
  std::vector<ScriptedCall> script;
};

// A body that stands on the floor for the whole run.
struct ObstacleSetup {
  std::string name;
  Footprint footprint;
  Pose pose;
};

// The radio as a function of time and place (design rule: traffic does not change it).
struct RadioSetup {
  enum class DelayModel : std::uint8_t { Constant, Uniform };  // always delay_s | uniform on [0, delay_s), which reorders
  double loss = 0.0;                   // share of receptions lost, independently
  double delay_s = 0.0;
  DelayModel delay_model = DelayModel::Constant;
  double range_m = 1000.0;             // between reference points at the instant of sending
  double air_time_s = 0.001;           // of the transmission itself; contained in the delay where that is longer
};

struct AgentClockSetup {
  double call_cost_s = 0.0;            // simulated time that every controller call takes
};

struct LawSetup {
  double safety_distance_m = 0.10;
  double snapshot_s = 0.0025;          // granularity of the published laws (400 a second)
  double reaction_s = 10.0;            // normal-operation: an agent may leave safe mode so much later than it could
  double min_transports_per_agv_hour = 0.0;  // normal-operation: a floor for the throughput of a run; 0: none
  Purposes exempt_purposes;            // safety-distance: bodies that both stay so near a station of such a purpose may be close to each other
  double exempt_radius_m = 0.0;
};

// Everything one simulation needs, as plain data.
struct Scenario {
  std::string name;
  std::shared_ptr<const LogicalMap> map;  // shared: the runs on one layout read the same curves
  std::vector<VehicleType> vehicle_types{VehicleType{}};
  std::vector<AgvSetup> agvs;
  std::vector<ObstacleSetup> obstacles;
  RadioSetup radio;
  AgentClockSetup agent_clock;
  LawSetup law;
  bool contact_stops = true;           // bodies that touch stand still from then on
  Duration horizon = std::chrono::seconds(600);
  Duration stuck_after = std::chrono::seconds(120);
  std::uint64_t seed = 0;              // of the world: keys of radio and agent randomness derive from it

  const VehicleType& type_of(const AgvSetup& agv) const { return vehicle_types[agv.type]; }
};

}  // namespace fleetproof
