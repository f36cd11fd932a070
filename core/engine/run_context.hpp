#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/engine/agv_status.hpp"
#include "core/engine/event_queue.hpp"
#include "core/engine/trace_writer.hpp"
#include "core/engine/world.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace_records.hpp"
#include "core/scenario/draw_numbers.hpp"
#include "core/scenario/order_table.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// What the draws of the motion stream are for; each is keyed by topic, AGV and number.
enum class MotionTopic : std::uint32_t { Speed = 1, Settling, Transfer, Position };

// If the floor has no room for a body or for what an operator does, it is tried again after this time.
constexpr Duration kBodyTriesAgain = std::chrono::seconds(1);

// What all parts of one run share: scenario, clock, queue, world, trace, counters, and the status of each AGV.
struct RunContext {
  // Requires: scenario, laws and sink outlive the run. `sink` may be null.
  RunContext(const Scenario& of, std::span<const std::unique_ptr<Law>> laws, TraceSink* sink);
  RunContext(const RunContext&) = delete;
  RunContext& operator=(const RunContext&) = delete;

  const Scenario& scenario;
  SimTime now = kStart;
  SimTime last_progress = kStart;  // of any AGV
  EventQueue queue;
  World world;
  TraceWriter writer;
  Counters counters;
  std::vector<AgvStatus> agvs;
  std::uint64_t motion_key;
  DrawNumbers draw_numbers;
  OrderTable orders;

  AgvStatus& status(AgvId agv) { return agvs[agv.index()]; }
  const AgvStatus& status(AgvId agv) const { return agvs[agv.index()]; }
  const AgvSetup& setup(AgvId agv) const { return scenario.agvs[agv.index()]; }
  const VehicleType& type_of(AgvId agv) const { return scenario.type_of(setup(agv)); }
  bool is_loaded(AgvId agv) const { return world.carried_load(agv).valid(); }
  Pose pose_now(EntityId id) const { return world.pose_of(id, now); }
  // Where a participant sends and receives now. Absent: a computer that is connected everywhere.
  std::optional<Vec2> antenna_m(EntityId participant) const {
    return scenario.is_agv(participant) ? pose_now(participant).position_m : scenario.computer(participant).at_m;
  }
  // A piece in which the AGV's body, as large as it is now, stands at `pose` from now on. A caller may set it in
  // motion.
  Piece standing_piece(AgvId agv, const Pose& pose) const;

  // In [0, 1).
  double motion_draw(MotionTopic topic, AgvId agv, std::uint32_t number) const;
  void progressed(AgvId agv) { last_progress = status(agv).last_progress = now; }

  bool transports_are_open() const;
  // The participants that are told of a transport: those from the first id on, up to the second one, without it.
  struct Audience {
    std::uint32_t first, end;
    bool has(EntityId participant) const { return first <= participant.value && participant.value < end; }
  };
  Audience audience_of(TransportId transport) const;
  // Requires: it was released.
  bool is_over(TransportId transport) const { return world.load(world.load_of(transport)).is_over(); }
  // The load of a transport that is released appears.
  LoadId add_load(TransportId transport);
  void move_load(LoadId load, Holder to);

  // `what` is one of the structs in traced (core/outcome/trace_records.hpp); `text` as TraceWriter has it.
  template <class What>
  void trace(EntityId entity, const What& what, std::string_view text = {}) {
    writer.write(trace_record(now, entity, what), text);
  }

  // What the scenario asks for and does not get now: see traced::Denied.
  void deny(EntityId entity, Denial why, std::uint64_t number) {
    writer.write_aside(trace_record(now, entity, traced::Denied{why, number}));
  }

  // Whether anything becomes of the notes of agents: an observer hears them, or the radio spares messages by their
  // kind.
  bool hears_notes() const { return hears_notes_; }
  // The same for a note of an agent.
  template <class What>
  void note(AgvId agv, const What& what, std::string_view text = {}) {
    writer.note(trace_record(now, agv, what), text);
  }

 private:
  bool hears_notes_;
};

}  // namespace fleetproof
