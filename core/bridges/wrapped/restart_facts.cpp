#include "core/bridges/wrapped/restart_facts.hpp"

#include <algorithm>

namespace fleetproof::wrapped {

RestartFacts::RestartFacts(const fp_briefing& briefing)
    : briefing_(briefing), station_(briefing.start_station), work_(briefing.fleet_count, FP_NONE) {
  for (const std::uint32_t segment : {briefing.start_segment, briefing.next_segment}) {
    if (briefing.role == FP_AGV && segment != FP_NONE) actions_.push_back(segment);
  }
}

std::uint32_t RestartFacts::end_of(std::uint32_t segment) const {
  if (segment == FP_HERE) return station_;
  const fp_station& here = *fp_station_at(briefing_.map, station_);
  for (std::uint32_t i = 0; i < here.lane_count; ++i) {
    const fp_lane& lane = *fp_lane_at(briefing_.map, here.lanes[i]);
    if (lane.segment == (segment & ~FP_BACKWARD)) return lane.to;
  }
  return station_;
}

RestartFacts::Order* RestartFacts::order(std::uint32_t id) {
  const auto found = std::ranges::find(orders_, id, [](const Order& order) { return order.told.order_id; });
  return found == orders_.end() ? nullptr : &*found;
}

void RestartFacts::put_down(std::uint32_t id) {
  Order* put = order(id);
  if (put == nullptr) return;
  put->is_done = put->told.to == station_;
  put->told.from = station_;
}

void RestartFacts::hear(const fp_event& event, const fp_perceived& seen) {
  if (event.kind == FP_EVENT_ORDER && order(event.order_id) == nullptr) orders_.push_back({event});
  if (event.kind == FP_EVENT_WITHDRAWN && seen.order_id != event.order_id) {
    if (Order* withdrawn = order(event.order_id)) withdrawn->is_done = true;
  }
  if (event.kind == FP_EVENT_ACTION_DONE && !actions_.empty()) {
    if (event.result == FP_OK) station_ = end_of(actions_.front());
    actions_.pop_front();
  }
  if (on_board_ != FP_NONE && on_board_ != seen.order_id) put_down(on_board_);
  on_board_ = seen.order_id;
}

// Only its program knows whether an open transport is done: it says on which one an AGV works, and then on which else.
void RestartFacts::works_on(std::uint32_t agv, std::uint32_t id) {
  if (briefing_.role != FP_COMPUTER || agv >= work_.size()) return;
  if (Order* before = order(work_[agv])) before->is_done = true;
  if (Order* now = order(id)) now->is_done = false;
  work_[agv] = id;
}

// A transfer begins when the AGV has reached the end of its segment.
const fp_briefing& RestartFacts::briefing_now(const fp_perceived& seen) {
  if (briefing_.role != FP_AGV) return briefing_;
  const bool is_transfer = seen.action == FP_PICKING || seen.action == FP_DROPPING || seen.action == FP_PARKED ||
                           seen.action == FP_CHARGING_NOW;
  std::vector<std::uint32_t> ways;
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    if (actions_[i] != FP_HERE && (i > 0 || !is_transfer)) ways.push_back(actions_[i]);
  }
  briefing_.start_station = is_transfer && !actions_.empty() ? end_of(actions_.front()) : station_;
  briefing_.start_segment = ways.empty() ? FP_NONE : ways[0];
  briefing_.next_segment = ways.size() > 1 ? ways[1] : FP_NONE;
  return briefing_;
}

std::vector<fp_event> RestartFacts::orders_now(const fp_perceived& seen) const {
  std::vector<fp_event> told;
  for (const Order& order : orders_) {
    if (!order.is_done) told.push_back(order.told);
  }
  std::stable_partition(told.begin(), told.end(),
                        [&](const fp_event& event) { return event.order_id == seen.order_id; });
  return told;
}

}  // namespace fleetproof::wrapped
