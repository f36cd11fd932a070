#include "core/engine/run_context.hpp"

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/outcome/work_and_progress.hpp"

namespace fleetproof {

RunContext::RunContext(const Scenario& of, std::span<const std::unique_ptr<Law>> laws, TraceSink* sink)
    : scenario(of),
      world(of, laws, sink),
      writer(laws, sink),
      agvs(of.agvs.size()),
      motion_key(stream_key(of.seed_of(Stream::Motion), Stream::Motion)),
      draw_numbers(of),
      orders(of),
      hears_notes_(sink != nullptr || !of.radio.adverse.spared_kinds.empty()) {
  ensure(of.entity_count() < EventOrder::kNoEntity, "every entity has a place in the order of events");
  for (std::size_t i = 0; i < agvs.size(); ++i) agvs[i].station = of.agvs[i].start;
}

Piece RunContext::standing_piece(AgvId agv, const Pose& pose) const {
  return rest_piece(agv, type_of(agv).footprint_with(is_loaded(agv)), pose, now);
}

double RunContext::motion_draw(MotionTopic topic, AgvId agv, std::uint32_t number) const {
  return unit_interval(
      word64(philox(motion_key, {number, 0, static_cast<std::uint32_t>(topic), draw_numbers.of(agv).value}), 0));
}

bool RunContext::transports_are_open() const { return open_transports(counters) > 0; }

void RunContext::move_load(LoadId load, Holder to) {
  world.move_load(load, to);
  trace_load(load);
}

void RunContext::trace_load(LoadId id) {
  const auto& [transport, carrier, holder, destination] = world.load(id);
  trace(carrier, traced::LoadMoves{id, holder});
}

}  // namespace fleetproof
