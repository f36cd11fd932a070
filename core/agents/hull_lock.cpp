#include "core/agents/hull_lock.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/agents/agent_type.hpp"
#include "core/agents/fleet.hpp"

namespace fleetproof::agents {
namespace {

enum Timer : std::uint32_t { kBeaconTimer = 1, kAskTimer = 2 };
enum Draws : std::uint32_t { kBeaconDraws = 10, kPatienceDraws = 11, kPlaceDraws = 12 };

constexpr double kBeacon_s = 1.0;
constexpr double kTransfer_s = 5.0;       // expected, of a pick or drop
constexpr double kTurn_s = 3.0;           // expected, of a turn on the spot
constexpr double kLongestLead_s = 8.0;    // how long before the end of a stretch the next one is asked for, at most
constexpr double kPatience_s = 10.0;      // how long one waits for somebody who stands in the way, plus up to half of it
constexpr double kPatienceInTheWay_s = 3.0;
constexpr double kRetryPlanning_s = 2.0;

}  // namespace

HullLock::HullLock(const fp_host& host, fp_controller* handle, const fp_briefing& briefing, LockOptions options)
    : controller_(host, handle),
      start_station_(briefing.start_station),
      map_(*briefing.map),
      geometry_(map_, briefing),
      neighbours_(map_, geometry_, briefing),
      protocol_(map_, geometry_, neighbours_, controller_, options),
      planner_(map_, geometry_, neighbours_, agv_of(briefing, briefing.self)),
      longest_claim_m_(longest_claim_m(map_)) {}

void HullLock::on_event(const fp_event& event) {
  switch (event.kind) {
    case FP_EVENT_START: start(); break;
    case FP_EVENT_ORDER:
      goals_.push_back({event.from, Leg::Kind::Pick});
      goals_.push_back({event.to, Leg::Kind::Drop});
      break;
    case FP_EVENT_MESSAGE:
      controller_.drain_inbox([&](std::uint32_t sender, std::span<const std::byte> bytes) { protocol_.receive(sender, bytes); });
      break;
    case FP_EVENT_TIMER:
      if (event.timer == kBeaconTimer) tick();
      break;
    case FP_EVENT_ACTION_DONE: action_done(event.result); break;
    default: break;
  }
  advance();
}

void HullLock::start() {
  Path standing;
  standing.station = start_station_;
  fp_pose pose{};
  if (controller_.pose(pose)) standing.heading = {pose.heading_x, pose.heading_y};
  protocol_.stand(standing);
  tick();
}

void HullLock::tick() {
  const double pause_s = kBeacon_s * (0.8 + 0.4 * controller_.random(kBeaconDraws));
  controller_.set_timer(kBeaconTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
  if (!out_of_order_ && is_waiting() && controller_.out_of_order()) break_down();
  protocol_.describe(is_waiting(), is_idle(), out_of_order_);
  reconsider();
  protocol_.broadcast_state();
}

void HullLock::action_done(std::int32_t result) {
  acting_ = false;
  if (result != FP_OK) return break_down();
  if (current_.kind == Leg::Kind::Drive) protocol_.lane_passed();
}

// It stands where it is for good. What it holds covers that.
void HullLock::break_down() {
  out_of_order_ = true;
  protocol_.withdraw();
}

void HullLock::advance() {
  for (int rounds = 0; rounds < 4; ++rounds) {
    act();
    protocol_.describe(is_waiting(), is_idle(), out_of_order_);
    if (protocol_.settle()) {
      adopt_stretch();
    } else if (!protocol_.requesting() && !out_of_order_) {
      plan();
      if (!protocol_.requesting() && (acting_ || legs_.empty())) break;
    } else {
      break;
    }
  }
  const std::int64_t ask_at_ns = protocol_.ask_again();
  if (ask_at_ns < 0 || ask_at_ns == ask_timer_ns_) return;
  ask_timer_ns_ = ask_at_ns;
  controller_.set_timer(kAskTimer, ask_at_ns);
}

void HullLock::act() {
  if (acting_ || legs_.empty() || out_of_order_) return;
  begin(legs_.front());
}

void HullLock::begin(const Leg& leg) {
  bool accepted = false;
  switch (leg.kind) {
    case Leg::Kind::Drive: accepted = controller_.move(map_.lane(leg.lane).segment); break;
    case Leg::Kind::Pick: accepted = controller_.pick(FP_HERE); break;
    case Leg::Kind::Drop: accepted = controller_.drop(FP_HERE); break;
  }
  if (!accepted) {
    if (controller_.out_of_order()) break_down();
    return;
  }
  current_ = leg;
  current_ends_s_ = now_s() + leg_time_s(leg, protocol_.held().heading);
  acting_ = true;
  legs_.pop_front();
}

void HullLock::adopt_stretch() {
  legs_.insert(legs_.end(), stretch_.legs.begin(), stretch_.legs.end());
  goals_.erase(goals_.begin(), goals_.begin() + stretch_.goals);
  if (purpose_ == Purpose::Transport) demand_ns_ = -1;
  const double took_s = std::min(now_s() - requested_at_s_, kLongestLead_s);
  locking_takes_s_ += 0.3 * (took_s - locking_takes_s_);
}

void HullLock::plan() {
  const std::uint32_t end = end_of(map_, protocol_.held()).station;
  while (!goals_.empty() && goals_.front().station == end) {
    legs_.push_back({goals_.front().transfer, FP_NONE});
    goals_.erase(goals_.begin());
  }
  if (now_s() < plan_after_s_) return;
  if (!goals_.empty()) {
    plan_transport();
  } else if (is_idle()) {
    plan_making_way();
  }
}

void HullLock::plan_transport() {
  if (time_left_s() > locking_takes_s_) return;
  if (demand_ns_ < 0) demand_ns_ = controller_.now_ns();
  request(way_on(), Purpose::Transport);
}

// An AGV without transports gets out of the way of those who ask, and of everybody if it stands at a bad place.
void HullLock::plan_making_way() {
  const bool asked = in_the_way_of(false);
  if (!asked && (planner_.places().is_safe(protocol_.held().station) || now_s() < 2.0)) return;
  if (asked) controller_.sometimes("makes-way");
  request(way_out(), Purpose::MakeWay);
}

Stretch HullLock::way_on() { return planner_.towards(end_of(map_, protocol_.held()), budget(), goals_); }

Stretch HullLock::way_out() { return planner_.out_of_the_way(protocol_.held(), budget(), is_idle(), controller_.random(kPlaceDraws)); }

void HullLock::request(Stretch stretch, Purpose purpose) {
  if (stretch.empty()) {
    plan_after_s_ = now_s() + kRetryPlanning_s;
    return;
  }
  stretch_ = std::move(stretch);
  purpose_ = purpose;
  requested_at_s_ = now_s();
  blocked_since_s_ = -1.0;
  protocol_.request(stretch_.path, demand_ns_ < 0 ? controller_.now_ns() : demand_ns_);
}

// Whoever waits for somebody who does nothing but wait himself looks for another way, and in the end gives way.
void HullLock::reconsider() {
  if (!protocol_.requesting() || !is_waiting() || out_of_order_) return;
  if (protocol_.waiting_inside(protocol_.requested()) == FP_NONE) {
    blocked_since_s_ = -1.0;
    return;
  }
  if (blocked_since_s_ < 0.0) {
    blocked_since_s_ = now_s();
    patience_s_ = kPatience_s * (1.0 + 0.5 * controller_.random(kPatienceDraws));
  }
  const Purpose purpose = goals_.empty() ? Purpose::MakeWay : Purpose::Transport;
  Stretch other = purpose == Purpose::Transport ? way_on() : way_out();
  if (!other.empty() && !(other.path == protocol_.requested()) && protocol_.waiting_inside(other.path) == FP_NONE) {
    controller_.sometimes("another-way-round");
    return request(std::move(other), purpose);
  }
  const double waited_s = now_s() - blocked_since_s_;
  if (waited_s < kPatienceInTheWay_s || !in_the_way_of(waited_s < patience_s_)) return;
  Stretch retreat = way_out();
  if (retreat.empty()) return;
  controller_.sometimes("retreat");
  request(std::move(retreat), Purpose::MakeWay);
}

// Does somebody ask for the place where it stands? `elder_only`: somebody whose demand is older.
bool HullLock::in_the_way_of(bool elder_only) {
  bool found = false;
  neighbours_.for_each([&](std::uint32_t agv, const Neighbour& n) {
    if (found || !n.request_is_open()) return;
    const std::uint32_t self = neighbours_.self();
    if (elder_only && std::tie(n.demand_ns, agv) > std::tie(demand_ns_, self)) return;
    found = geometry_.conflict(self, protocol_.held(), agv, n.request);
  });
  return found;
}

Budget HullLock::budget() const { return {longest_claim_m_ - length_m(map_, protocol_.held()), kPathLanesMax - protocol_.held().count}; }

double HullLock::time_left_s() {
  double left_s = acting_ ? std::max(0.0, current_ends_s_ - now_s()) : 0.0;
  Vec heading = protocol_.held().heading;
  for (const Leg& leg : legs_) {
    left_s += leg_time_s(leg, heading);
    if (leg.kind == Leg::Kind::Drive) heading = map_.end_heading(leg.lane);
  }
  return left_s;
}

double HullLock::leg_time_s(const Leg& leg, Vec heading) const {
  if (leg.kind != Leg::Kind::Drive) return kTransfer_s;
  return planner_.lane_time_s(leg.lane) + (same_heading(heading, map_.start_heading(leg.lane)) ? 0.0 : kTurn_s);
}

void* create_hull_lock(const fp_host* host, fp_controller* controller, const fp_briefing* briefing, LockOptions options) {
  constexpr std::uint32_t kNumbersOnTheWire = 0xffff;
  const fp_map& map = *briefing->map;
  if (map.station_count > kNumbersOnTheWire || map.lane_count > kNumbersOnTheWire) return nullptr;
  return new HullLock(*host, controller, *briefing, options);
}

constinit const fp_agent_type kHullLock = agent_type<HullLock>(
    "hull-lock", "locks the floor it is going to cover before it drives; sound under any loss and delay",
    [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) { return create_hull_lock(host, controller, briefing, {}); });

}  // namespace fleetproof::agents
