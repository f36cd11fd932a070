#pragma once

#include <cstdint>

#include "core/motion/activity.hpp"
#include "core/outcome/counters.hpp"

namespace fleetproof {

// What counts as work and what counts as progress, in one place. The definitions differ because the questions differ:
//
// question                                    | who asks                              | definition
// --------------------------------------------|---------------------------------------|------------------------------
// Does the AGV do anything now?               | every other question                  | is_work
// Is the fleet frozen? (run "stuck",          | engine at the end of a run, operator, | no AGV works, and no work
//   operator, deadlock, standstill)           | laws progress and normal-operation    |   began or ended for
//                                             |                                       |   `stuck_after`; all but the
//                                             |                                       |   operator excuse who charges
// Does the fleet move without any result?     | law progress (livelock, starvation)   | no transport advanced
//   Movement alone is no progress.            |                                       |   (advances_transport), no
//                                             |                                       |   charge ended (is_progress),
//                                             |                                       |   and not everybody charges
// Is there anything left to do?               | all of them                           | open_transports
// How much does the fleet get done?           | gates, reports, law normal-operation  | transports_per_agv_hour
//
// A frozen fleet is found by its lack of work and not by its lack of results: the time that a transport or a drive
// takes depends on the layout, the time in which an idle AGV begins something does not. For engine and operator, work
// also begins when a fault, the scanner or the operator lets an AGV go. An agent that stops its AGV and lets it go on
// does no work by that.

// Activities by which an AGV serves its transports. A transmission is no activity of the AGV's body.
constexpr bool is_work(ActivityKind kind) {
  return kind == ActivityKind::Drive || kind == ActivityKind::Turn || kind == ActivityKind::Settle ||
         kind == ActivityKind::Pick || kind == ActivityKind::Drop;
}

// Activities that end by themselves. A charge ends when the battery is full, at the latest; an AGV that parks may stay
// so for as long as it likes.
constexpr bool keeps_busy(ActivityKind kind) { return is_work(kind) || kind == ActivityKind::Charge; }

// Whether a transport advances when its load passes to `to`: an AGV has taken the load up, or nothing is left to do
// because the load is out of the warehouse. The delivery itself is a record of its own (TraceKind::TransportDone). A
// load that falls, or that is put down elsewhere, advances nothing.
constexpr bool advances_transport(const Holder& to) {
  return to.kind == Holder::Kind::Agv || to.kind == Holder::Kind::ClearedAway;
}

// Whether the end of an activity is progress in itself: a charge to the end, or one that was cut short after
// `stuck_after` or later. The AGV has what it came for, and it can go on with its transports.
constexpr bool is_progress(ActivityKind ended, bool as_planned, Duration lasted, Duration stuck_after) {
  return ended == ActivityKind::Charge && (as_planned || lasted >= stuck_after);
}

// Transports that were released and are neither done, nor withdrawn, nor impossible because their load was cleared
// away.
constexpr std::uint64_t open_transports(const Counters& counters) {
  const std::uint64_t over = counters.transports_done + counters.loads_cleared + counters.transports_withdrawn;
  return over < counters.transports_released ? counters.transports_released - over : 0;
}

// Throughput: finished transports alone count. Requires: agv_hours > 0.
constexpr double transports_per_agv_hour(std::uint64_t transports_done, double agv_hours) {
  return static_cast<double>(transports_done) / agv_hours;
}

}  // namespace fleetproof
