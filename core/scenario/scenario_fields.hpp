#pragma once

#include "core/scenario/fault_fields.hpp"
#include "core/scenario/radio_fields.hpp"
#include "core/scenario/scenario.hpp"
#include "core/scenario/vehicle_fields.hpp"

// The fields of a scenario and of its parts, in the order of scenario files.
namespace fleetproof {

inline constexpr double kFloorEnd_m = 100'000.0;  // coordinates lie within this distance of the origin
inline constexpr double kLargestClockOffset_s = 1e6, kLargestClockDrift_ppm = 1e5;

// A direction, for visitors; any other Vec2 is a place.
template <class Vector>
struct Direction {
  Vector& vector;
};
// The index of a vehicle type of the scenario, for visitors.
template <class Index>
struct TypeIndex {
  Index& index;
};

// A scenario and a campaign have these in common.
inline constexpr Field kSeed{.key = "seed",
                             .text = "seed of everything that is drawn",
                             .lenient = Lenient::none("every seed is an attempt of the ledger"),
                             .is_seed = true};
inline constexpr Field kHorizon{.key = "horizon_s",
                                .text = "length of a run",
                                .lenient = Lenient::down(Weight::Load),
                                .high = 1e7,
                                .above_low = true};
inline constexpr Field kStuckAfter{.key = "stuck_after_s",
                                   .text = "a run is stuck if nothing begins or ends for so long",
                                   .lenient = Lenient::up(Weight::Judgement),
                                   .high = kLongest_s,
                                   .above_low = true};
inline constexpr Field kContactStops{.key = "contact_stops",
                                     .text = "bodies that touch stand still from then on",
                                     .lenient = Lenient::down(Weight::Judgement)};

template <FieldsOf<SensingSetup> Sensing, class Visit>
void visit_fields(Sensing& sensing, Visit&& visit) {
  auto& [clock_offset_s, clock_drift_ppm, position_error_m, position_late_s] = sensing;
  visit(Field{.key = "clock_offset_s",
              .text = "the AGV's clock is ahead by this much",
              .lenient = kOfScenarios,
              .high = kLargestClockOffset_s},
        clock_offset_s);
  visit(Field{.key = "clock_drift_ppm",
              .text = "and runs too fast by this much",
              .lenient = kOfScenarios,
              .low = -kLargestClockDrift_ppm,
              .high = kLargestClockDrift_ppm},
        clock_drift_ppm);
  visit(Field{.key = "position_error_m",
              .text = "each coordinate of getPosition is wrong by up to this",
              .lenient = kOfScenarios,
              .high = kLargestBody_m},
        position_error_m);
  visit(Field{.key = "position_late_s",
              .text = "getPosition tells where the AGV was so long ago",
              .lenient = kOfScenarios,
              .high = kHour_s},
        position_late_s);
}

template <FieldsOf<TransportOrder> Order, class Visit>
void visit_fields(Order& order, Visit&& visit) {
  auto& [from, to, release, withdrawn] = order;
  visit(Field{.key = "from", .text = "station where the load is", .lenient = kOfScenarios, .needed = true}, from);
  visit(Field{.key = "to", .text = "station where the load goes", .lenient = kOfScenarios, .needed = true}, to);
  visit(Field{.key = "release_s",
              .text = "when the agent gets the order",
              .lenient = kOfScenarios,
              .high = kLongest_s,
              .needed = true},
        release);
  visit(Field{.key = "withdrawn_s",
              .text = "when it is withdrawn; it is over then, unless its load was taken up before; left out: never",
              .lenient = kOfScenarios,
              .high = kLongest_s,
              .left_out = withdrawn == kLongestDuration,
              .is_later = true},
        withdrawn);
}

template <FieldsOf<ScriptedCall> Call, class Visit>
void visit_fields(Call& call, Visit&& visit) {
  auto& [at, action, segment, backward] = call;
  visit(
      Field{
          .key = "at_s", .text = "when the call is made", .lenient = kOfScenarios, .high = kLongest_s, .needed = true},
      at);
  visit(Field{.key = "action", .text = "the controller call", .lenient = kOfScenarios, .needed = true}, action);
  visit(Field{.key = "segment",
              .text = "name of the segment that the AGV drives first; left out of pick, drop, park or charge: it stays "
                      "where it stands",
              .lenient = kOfScenarios,
              .left_out = !segment.valid()},
        segment);
  visit(Field{.key = "backward",
              .text = "whether the AGV drives the segment backward",
              .lenient = kOfScenarios,
              .left_out = !backward},
        backward);
}

template <FieldsOf<AgvSetup> Agv, class Visit>
void visit_fields(Agv& agv, Visit&& visit) {
  auto& [name, type, start, heading, battery, sensing, transports, script, draws_as] = agv;
  visit(Field{.key = "name", .text = "name of the AGV", .lenient = kIsName, .needed = true}, name);
  visit(Field{.key = "type", .text = "name of its vehicle type; left out: the first one", .lenient = kOfScenarios},
        TypeIndex<decltype(type)>{type});
  visit(Field{.key = "start", .text = "station where it stands at first", .lenient = kOfScenarios, .needed = true},
        start);
  visit(Field{.key = "heading", .text = "direction [x, y] in which it looks at first", .lenient = kOfScenarios},
        Direction<std::remove_reference_t<decltype(heading)>>{heading});
  visit(Field{.key = "battery", .text = "level at first; 1: full", .lenient = kOfScenarios}, battery);
  visit(Field{.key = "sensing",
              .text = "how wrong its own clock and position are",
              .lenient = kOfScenarios,
              .left_out = sensing == SensingSetup{}},
        sensing);
  visit(Field{.key = "transports", .text = "its orders", .lenient = kOfScenarios}, transports);
  visit(Field{.key = "script",
              .text = "controller calls of the `scripted` agent, in order of time",
              .lenient = kOfScenarios},
        script);
  visit(Field{.key = "draws_as",
              .text = "number under which what is random about it is drawn; left out: its place in the list",
              .lenient = kOfScenarios,
              .high = 65535.0,
              .left_out = !draws_as.has_value(),
              .is_later = true},
        draws_as);
}

template <FieldsOf<ComputerSetup> Computer, class Visit>
void visit_fields(Computer& computer, Visit&& visit) {
  auto& [name, at_m, clock_offset_s, clock_drift_ppm, agent, agent_config, draws_as] = computer;
  visit(Field{.key = "name", .text = "name of the computer", .lenient = kIsName, .needed = true}, name);
  visit(Field{.key = "at_m",
              .text = "[x, y] of its antenna; left out: it is in range of every AGV",
              .lenient = Lenient::none("a plant has its own"),
              .low = -kFloorEnd_m,
              .high = kFloorEnd_m,
              .left_out = !at_m.has_value()},
        at_m);
  visit(Field{.key = "clock_offset_s",
              .text = "its clock is ahead by this much",
              .lenient = kOfScenarios,
              .high = kLargestClockOffset_s,
              .home = FieldHome::ScenarioOnly},
        clock_offset_s);
  visit(Field{.key = "clock_drift_ppm",
              .text = "and runs too fast by this much",
              .lenient = kOfScenarios,
              .low = -kLargestClockDrift_ppm,
              .high = kLargestClockDrift_ppm,
              .home = FieldHome::ScenarioOnly},
        clock_drift_ppm);
  visit(Field{.key = "agent",
              .text = "its program; left out: the caller names it",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = agent.empty()},
        agent);
  visit(Field{.key = "agent_config",
              .text = "a text that this program gets at its start",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = agent_config.empty()},
        agent_config);
  visit(Field{.key = "draws_as",
              .text = "place among the computers under which what is random about it is drawn; left out: its own",
              .lenient = kOfScenarios,
              .high = kMostComputers - 1.0,
              .home = FieldHome::ScenarioOnly,
              .left_out = !draws_as.has_value()},
        draws_as);
}

template <FieldsOf<WireSetup> Wire, class Visit>
void visit_fields(Wire& wire, Visit&& visit) {
  auto& [takes_s] = wire;
  visit(Field{.key = "takes_s",
              .text = "time from sending to reception between two computers",
              .lenient = Lenient::down(Weight::Load),
              .high = kHour_s},
        takes_s);
}

template <FieldsOf<ObstacleSetup> Obstacle, class Visit>
void visit_fields(Obstacle& obstacle, Visit&& visit) {
  auto& [name, footprint, pose, appears, leaves] = obstacle;
  auto& [length_m, width_m, centre_ahead_m] = footprint;
  auto& [position_m, heading] = pose;
  Field length = kLength, width = kWidth;
  length.needed = width.needed = true;
  visit(Field{.key = "name", .text = "name of the obstacle", .lenient = kIsName, .needed = true}, name);
  visit(length, length_m);
  visit(width, width_m);
  visit(Field{.key = "position_m",
              .text = "[x, y] of its centre",
              .lenient = kOfScenarios,
              .low = -kFloorEnd_m,
              .high = kFloorEnd_m,
              .needed = true},
        position_m);
  visit(Field{.key = "heading", .text = "direction [x, y] of its length", .lenient = kOfScenarios},
        Direction<std::remove_reference_t<decltype(heading)>>{heading});
  visit(Field{.key = "appears_s",
              .text = "when it appears; 0: it is there from the start",
              .lenient = kOfScenarios,
              .high = kLongest_s,
              .left_out = appears == Duration::zero()},
        appears);
  visit(Field{.key = "leaves_s",
              .text = "when it leaves; left out: never",
              .lenient = kOfScenarios,
              .high = kLongest_s,
              .left_out = leaves == kLongestDuration},
        leaves);
}

template <FieldsOf<AgentClockSetup> Clock, class Visit>
void visit_fields(Clock& clock, Visit&& visit) {
  auto& [call_cost_s] = clock;
  visit(Field{.key = "call_cost_s",
              .text = "simulated time that every controller call takes",
              .lenient = Lenient::down(Weight::Load),
              .high = 60.0},
        call_cost_s);
}

// The safety distance is above 0, as two bodies cannot be closer than that, and at most 0.5 m: up to there a run's
// smallest clearance is exact.
template <FieldsOf<LawSetup> Law, class Visit>
void visit_fields(Law& law, Visit&& visit) {
  auto& [safety_distance_m, snapshot_s, reaction_s, min_transports_per_agv_hour, exempt_purposes, exempt_radius_m,
         exempt_pairs, leave_out] = law;
  visit(Field{.key = "safety_distance_m",
              .text = "bodies that come closer than this violate the safety distance",
              .lenient = Lenient::down(Weight::Judgement),
              .low = 0.001,
              .high = 0.5},
        safety_distance_m);
  visit(Field{.key = "snapshot_s",
              .text = "time between two snapshots of the published laws",
              .lenient = kOfScenarios,
              .low = 1e-6,
              .high = kLongest_s,
              .home = FieldHome::ScenarioOnly},
        snapshot_s);
  visit(Field{.key = "reaction_s",
              .text = "an agent may leave safe mode so much later than it could",
              .lenient = Lenient::up(Weight::Judgement),
              .high = kHour_s},
        reaction_s);
  visit(Field{.key = "min_transports_per_agv_hour",
              .text = "a run with a lower throughput is not normal operation; 0: any will do",
              .lenient = Lenient::down(Weight::Judgement),
              .high = 3600.0},
        min_transports_per_agv_hour);
  visit(Field{.key = "exempt_purposes",
              .text = "bodies near stations of such a purpose may be close to each other",
              .lenient = kToldAtHead},
        exempt_purposes);
  visit(Field{.key = "exempt_radius_m",
              .text = "how near, for exempt_purposes",
              .lenient = kToldAtHead,
              .high = kLargestBody_m},
        exempt_radius_m);
  visit(Field{.key = "exempt_pairs",
              .text = "pairs of vehicle types, or \"obstacle\", that may be close to each other anywhere",
              .lenient = kToldAtHead,
              .left_out = exempt_pairs.empty()},
        exempt_pairs);
  visit(Field{.key = "leave_out",
              .text = "laws that are not run",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = leave_out.empty(),
              .is_later = true},
        leave_out);
}

template <FieldsOf<ExpectedOutcome> Expected, class Visit>
void visit_fields(Expected& expected, Visit&& visit) {
  auto& [failure, digest] = expected;
  visit(
      Field{.key = "failure", .text = "how the run fails, as shrink says it", .lenient = kOfScenarios, .needed = true},
      failure);
  visit(Field{.key = "digest",
              .text = "digest of its trace, as 0x and hexadecimal digits",
              .lenient = kOfScenarios,
              .is_seed = true},
        digest);
}

inline constexpr Field kOpenTransports{
    .key = "transports",
    .text = "open transports: the computers hear of them, or without computers all AGVs",
    .lenient = kOfScenarios,
    .is_later = true};

template <FieldsOf<Scenario> Given, class Visit>
void visit_fields(Given& scenario, Visit&& visit) {
  auto& [name, map, vehicle_types, agvs, open_orders, computers, wire, obstacles, faults, scanner, operator_help, radio,
         deliveries, agent_clock, law, contact_stops, horizon, stuck_after, seed, stream_seeds, agent, agent_config,
         expected] = scenario;
  visit(Field{.key = "name", .text = "name of the scenario", .lenient = kIsName}, name);
  visit(kSeed, seed);
  visit(Field{.key = "stream_seeds",
              .text = "streams of randomness that have a seed of their own",
              .lenient = kOfScenarios,
              .left_out = stream_seeds.empty()},
        stream_seeds);
  visit(Field{.key = "agent",
              .text = "the control software of the fleet; left out: the caller names it, or a script moves the AGVs",
              .lenient = kOfScenarios,
              .left_out = agent.empty()},
        agent);
  visit(Field{.key = "agent_config",
              .text = "a text that every agent gets at its start",
              .lenient = kOfScenarios,
              .left_out = agent_config.empty()},
        agent_config);
  visit(Field{.key = "expected",
              .text = "what a saved case is known to do; it changes nothing",
              .lenient = kOfScenarios,
              .left_out = expected == ExpectedOutcome{},
              .is_later = true},
        expected);
  visit(kHorizon, horizon);
  visit(kStuckAfter, stuck_after);
  visit(kContactStops, contact_stops);
  visit(Field{.key = "radio", .text = "the radio", .lenient = kIsTable}, radio);
  visit(Field{.key = "agent_clock", .text = "the agent's computer", .lenient = kIsTable}, agent_clock);
  visit(Field{.key = "law", .text = "what the laws ask", .lenient = kIsTable}, law);
  visit(Field{.key = "vehicle_types", .text = "kinds of AGVs", .lenient = kIsTable}, vehicle_types);
  visit(Field{.key = "agvs", .text = "the fleet", .lenient = kOfScenarios, .needed = true}, agvs);
  visit(kOpenTransports.left_out_if(open_orders.empty()), open_orders);
  visit(Field{.key = "computers",
              .text = "participants without a body: servers, brokers",
              .lenient = kOfScenarios,
              .left_out = computers.empty(),
              .is_later = true},
        computers);
  visit(Field{.key = "wire",
              .text = "what connects the computers with each other",
              .lenient = kIsTable,
              .left_out = wire == WireSetup{},
              .is_later = true},
        wire);
  visit(Field{.key = "obstacles", .text = "bodies that stand on the floor", .lenient = kOfScenarios}, obstacles);
  visit(Field{.key = "faults", .text = "what goes wrong, and when", .lenient = kIsTable, .left_out = faults.empty()},
        faults);
  visit(
      Field{.key = "scanner", .text = "the laser scanners", .lenient = kIsTable, .left_out = scanner == ScannerSetup{}},
      scanner);
  visit(
      Field{
          .key = "operator", .text = "the operator", .lenient = kIsTable, .left_out = operator_help == OperatorSetup{}},
      operator_help);
  visit(Field{.key = "fates",
              .text = "what becomes of single messages, whatever the radio would draw for them",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = deliveries.empty()},
        deliveries);
  visit(Field{.key = "layout", .text = "the logical map", .lenient = kOfScenarios, .needed = true}, map);
}

// Structs that have a list of fields.
template <class Setup>
concept HasFields = requires(Setup& setup) {
  visit_fields(setup, [](const Field&, auto&&) {});
};

}  // namespace fleetproof
