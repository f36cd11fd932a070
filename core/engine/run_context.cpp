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

// An open transport is told to every computer; without computers, to every AGV.
RunContext::Audience RunContext::audience_of(TransportId transport) const {
  const AgvId agv = orders.agv_of(transport);
  if (agv.valid()) return {agv.value, agv.value + 1};
  const auto fleet = static_cast<std::uint32_t>(agvs.size()),
             all = static_cast<std::uint32_t>(scenario.participant_count());
  return fleet < all ? Audience{fleet, all} : Audience{0, fleet};
}

LoadId RunContext::add_load(TransportId transport) {
  const TransportOrder& order = orders.order(transport);
  const LoadId load = world.add_load(transport, orders.agv_of(transport), order.from, order.to);
  trace(orders.agv_of(transport), traced::OrderReleased{transport});
  trace(orders.agv_of(transport), traced::LoadMoves{load, world.load(load).holder});
  return load;
}

// The record is about the AGV of the transport. If an open transport loses its AGV here, that AGV is named.
void RunContext::move_load(LoadId id, Holder to) {
  const AgvId before = world.load(id).carrier;
  world.move_load(id, to);
  const AgvId now_of = world.load(id).carrier;
  trace(now_of.valid() ? now_of : before, traced::LoadMoves{id, to});
}

}  // namespace fleetproof
