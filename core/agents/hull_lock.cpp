#include "core/agents/hull_lock.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/agents/fleet.hpp"

namespace fleetproof::agents {
namespace {

enum Timer : std::uint32_t { kTickTimer = 1, kRepeatTimer = 2 };
enum LockDraws : std::uint32_t { kTickDraws = 10, kPlaceDraws = 12, kRepeatDraws = 13 };

constexpr double kTick_s = 1.0;
constexpr double kRepeat_s = 0.5;
constexpr double kLongestLead_s = 8.0;  // how long before the end of a section the next one is asked for, at most
constexpr double kRetryPlanning_s = 2.0;
constexpr double kOverdue_s = 5.0;     // an action that takes this much longer than expected may have been stopped
constexpr double kClockMargin = 1.02;  // clocks may run wrong by up to 1 %
constexpr std::uint32_t kLooksPerChoice = 8;
constexpr double kEarly_s = 2.0;

// Members of the briefing that a host of minor version 0 does not have.
bool knows_restarts(const fp_briefing& briefing) {
  return briefing.struct_size >= offsetof(fp_briefing, next_segment) + sizeof(briefing.next_segment);
}

double braking_s(const fp_briefing& briefing) {
  return highest_speed_mps(briefing, briefing.self) / agv_of(briefing, briefing.self).deceleration_mps2;
}

}  // namespace

HullLock::HullLock(const fp_host& host, fp_controller* handle, const fp_briefing& briefing, const LockOptions& options)
    : options_(options),
      settings_(read_settings(briefing.config)),
      boot_(knows_restarts(briefing) ? briefing.boot : 0),
      start_station_(briefing.start_station),
      start_segment_(boot_ > 0 ? briefing.start_segment : FP_NONE),
      next_segment_(boot_ > 0 ? briefing.next_segment : FP_NONE),
      controller_(host, handle, boot_),
      errands_(controller_, boot_),
      facts_(briefing),
      map_(facts_.shared()),
      geometry_(map_, briefing, options.hulls),
      neighbours_(map_, geometry_, briefing, settings_, options),
      protocol_(map_, geometry_, neighbours_, controller_, options, options.consent.epochs_name_boot ? boot_ : 0),
      planner_(map_, geometry_, neighbours_, tells_minor_2(briefing) ? agv_of(briefing, briefing.self).vehicle_type : 0,
               options.progress),
      right_of_way_(neighbours_, controller_, options.progress),
      way_(map_, agv_of(briefing, briefing.self)),
      has_chargers_(map_.has_chargers()),
      braking_s_(braking_s(briefing)) {}

void HullLock::on_event(const fp_event& event) {
  controller_.set_clock(event.now_ns);
  switch (event.kind) {
    case FP_EVENT_START:
      start();
      break;
    case FP_EVENT_ORDER:
      errands_.take(event);
      break;
    case FP_EVENT_MESSAGE:
      controller_.drain_inbox(
          [&](std::uint32_t sender, std::span<const std::byte> bytes) { protocol_.receive(sender, bytes); });
      break;
    case FP_EVENT_TIMER:
      if (event.timer == kTickTimer) tick();
      if (event.timer == kRepeatTimer) repeat();
      break;
    case FP_EVENT_ACTION_DONE:
      action_done(event.result);
      break;
    default:
      break;
  }
  advance();
}

void HullLock::start() {
  Path standing;
  standing.station = start_station_;
  fp_pose pose{};
  if (controller_.pose(pose)) standing.heading = {pose.heading_x, pose.heading_y};
  protocol_.stand(standing);
  if (boot_ > 0) neighbours_.restarted_at(controller_.now_ns());
  started_s_ = now_s();
  if (boot_ > 0 && options_.holding.lanes_over_restarts) start_again(standing);
  tick();
  repeat();
}

// The AGV may still carry out actions of the former self. The agent holds the floor of these actions until they end.
void HullLock::start_again(const Path& standing) {
  controller_.sometimes("restarted");
  Path driving = standing;
  const bool drives = append_segment(map_, driving, start_segment_);
  const bool drives_next = append_segment(map_, driving, next_segment_);
  // The AGV may still be turning to the first lane, from anywhere: the hull of half a turn is a disc.
  const double away = options_.holding.turns_over_restarts ? -1.0 : 1.0;
  if (!driving.empty()) driving.heading = map_.start_heading(driving.lane_ids[0]) * away;
  protocol_.stand(driving);
  way_.begin(drives ? Leg{Leg::Kind::Drive, driving.lane_ids[0]} : Leg{Leg::Kind::Inherited}, driving.heading, now_s());
  if (drives_next) {
    way_.append({Leg::Kind::Drive, driving.lane_ids[driving.count - 1]});
    way_.give_next();
  }
  if (!driving.empty()) return;
  place_known_ = false;
  place_known_after_s_ = now_s() + kClockMargin * settings_.position_late_s + 0.1;
  protocol_.know_own_place(false);
}

void HullLock::tick() {
  const double pause_s = kTick_s * (0.8 + 0.4 * controller_.random(kTickDraws));
  controller_.set_timer(kTickTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
  release_early();
  find_own_place();
  look_for_inherited_action();
  look_whether_out_of_order();
  if (has_chargers_) look_at_battery();
  protocol_.describe(is_waiting(), is_idle(), out_of_order_);
  reconsider();
}

void HullLock::repeat() {
  const double pause_s = kRepeat_s * (0.8 + 0.4 * controller_.random(kRepeatDraws));
  controller_.set_timer(kRepeatTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
  protocol_.describe(is_waiting(), is_idle(), out_of_order_);
  protocol_.repeat();
}

void HullLock::action_done(std::int32_t result) {
  if (!way_.acting()) return;
  if (result != FP_OK) {  // it stays where it is for good; its held hull covers that place
    way_.stop();
    wrecked_ = true;
    return set_out_of_order(true);
  }
  if (way_.current().kind == Leg::Kind::Drive && !current_released_) protocol_.lane_passed();
  if (way_.current().kind == Leg::Kind::Charge) charging_ = true;
  current_released_ = false;
  way_.end(now_s());
}

// The AGV has been at rest since the restart. When no position can be older than the restart, the heading is right. An
// AGV that a contact stopped is out of order: it may be beside the station, nearer than a position can tell.
void HullLock::find_own_place() {
  if (place_known_ || now_s() < place_known_after_s_ || controller_.out_of_order()) return;
  fp_pose pose{};
  if (!controller_.pose(pose)) return;
  const double off_m = length(Vec{pose.x_m, pose.y_m} - map_.position_m(start_station_));
  if (off_m > 2.0 * settings_.position_error_m + kHullTolerance_m)
    return;  // somewhere on an unknown lane: no other AGV may come near
  Path standing;
  standing.station = start_station_;
  standing.heading = {pose.heading_x, pose.heading_y};
  protocol_.stand(standing);
  protocol_.know_own_place(true);
  place_known_ = true;
}

// The agent does not know whether an action of the former self was under way. If one was, its end arrives as an event.
// If the AGV was idle at one tick and no such event arrives before the next tick, there was none.
void HullLock::look_for_inherited_action() {
  if (!way_.acting() || way_.current().kind != Leg::Kind::Inherited) return;
  const std::uint32_t action = controller_.action();
  const bool idle = action == FP_IDLE || action == FP_CHARGING_NOW;
  if (idle && seen_idle_) way_.stop(), charging_ = action == FP_CHARGING_NOW;
  seen_idle_ = idle;
}

void HullLock::look_whether_out_of_order() {
  if (wrecked_ || !(out_of_order_ || is_waiting() || now_s() > way_.current_ends_s() + kOverdue_s)) return;
  set_out_of_order(controller_.out_of_order());
}

// The AGV keeps what it holds, and goes on when it has been repaired.
void HullLock::set_out_of_order(bool out) {
  if (out && !out_of_order_) protocol_.withdraw();
  if (out && !options_.holding.lanes_over_failures) release_lane();
  out_of_order_ = out;
}

// Before the end of the lane: only if a rule of holding is broken.
void HullLock::release_lane() {
  if (!way_.acting() || way_.current().kind != Leg::Kind::Drive || current_released_) return;
  protocol_.lane_passed();
  current_released_ = true;
}

void HullLock::release_early() {
  if (!options_.holding.lanes_to_their_end && now_s() >= way_.current_ends_s() - kEarly_s) release_lane();
}

// Before a pick where it stands or will stand. True: not yet, or there is a charger to go to.
bool HullLock::charges_first() {
  if (!is_battery_low()) return false;
  if (way_.acting() || !way_.empty()) return true;
  look_at_battery();
  return errands_.next_is(Leg::Kind::Charge);
}

void HullLock::look_at_battery() {
  const double level = controller_.battery_level();
  if (level >= settings_.charge_to) charging_ = false;
  const bool urgent = settings_.is_urgent(level, carries_load(errands_.goals()));
  const bool in_between = urgent || !errands_.next_is(Leg::Kind::Drop);
  const bool transfers = way_.contains(Leg::Kind::Pick) || (way_.acting() && way_.current().kind == Leg::Kind::Drop);
  if (settings_.is_low(level) && !charging_ && in_between && !transfers && !way_.contains(Leg::Kind::Charge) &&
      place_known_ && !out_of_order_)
    drive_to_charger(urgent);
}

// Drives to the charger that is best now. Since the last choice, chargers may have become free or occupied.
void HullLock::drive_to_charger(bool urgent) {
  const bool bound = errands_.next_is(Leg::Kind::Charge);
  if (bound && (!protocol_.requesting() || ++looks_ % kLooksPerChoice != 0)) return;
  const bool loaded = carries_load(errands_.goals());
  const std::uint32_t charger = planner_.free_charger(end_of(map_, protocol_.held()), loaded, urgent);
  if (charger == FP_NONE || (bound && errands_.goals().front().station == charger)) return;
  protocol_.withdraw();  // a request counts goals by their numbers in the row
  errands_.charge_at(charger);
  controller_.sometimes("drives-to-charger");
}

void HullLock::advance() {
  for (int rounds = 0; rounds < 4; ++rounds) {
    act();
    protocol_.describe(is_waiting(), is_idle(), out_of_order_);
    if (protocol_.settle()) {
      adopt_section();
    } else if (!protocol_.requesting() && !out_of_order_ && place_known_) {
      plan();
      if (!protocol_.requesting() && (way_.acting() || way_.empty())) break;
    } else {
      break;
    }
  }
  controller_.declare_state(state());
}

void HullLock::act() {
  if (charging_ || out_of_order_) return;
  if (!way_.acting()) {
    while (!way_.empty() && errands_.is_needless(way_.next())) way_.drop_next();
    if (!way_.empty() && !must_lock_first()) begin(way_.next());
  }
  if (way_.can_roll_on() && !current_released_) roll_on();
}

// The next move is given while the AGV still drives, so that it passes the station without a stop.
void HullLock::roll_on() {
  const std::uint32_t lane = way_.next().lane;
  if (protocol_.may_drive_next(lane) && controller_.move(map_.action_segment(lane))) way_.give_next();
}

void HullLock::begin(Leg leg) {
  bool accepted = false;
  switch (leg.kind) {
    case Leg::Kind::Drive:
      accepted = protocol_.may_drive(leg.lane) && controller_.move(map_.action_segment(leg.lane));
      break;
    case Leg::Kind::Pick:
      accepted = controller_.pick_load(FP_HERE, leg.order);
      break;
    case Leg::Kind::Drop:
      accepted = controller_.drop(FP_HERE);
      break;
    case Leg::Kind::Charge:
      accepted = controller_.charge(FP_HERE);
      break;
    case Leg::Kind::Inherited:
      break;
  }
  if (!accepted) {
    set_out_of_order(controller_.out_of_order());
    if (leg.kind != Leg::Kind::Pick || controller_.action() != FP_IDLE) return;
    protocol_.withdraw();  // a request counts goals by their numbers in the row
    errands_.forget(leg.order);
    return way_.drop_next();
  }
  way_.drop_next();
  way_.begin(leg, protocol_.held().heading, now_s());
}

void HullLock::adopt_section() {
  for (const Leg& leg : section_.legs) way_.append(leg);
  errands_.reached(section_.goals);
  has_locked_ = true;
  if (section_.goals > 0) seniority_.meet();  // an AGV that gets on only step by step stays old
  right_of_way_.got_on();
  charging_ = false;  // of the AGVs that charge, only one that makes way locks floor
  const double took_s = std::min(now_s() - requested_at_s_, kLongestLead_s);
  locking_takes_s_ += 0.3 * (took_s - locking_takes_s_);
}

void HullLock::plan() {
  const Path end = end_of(map_, protocol_.held());
  while (!errands_.empty() && errands_.goals().front().station == end.station &&
         map_.may_stay(end.station, end.heading)) {
    if (errands_.next_is(Leg::Kind::Pick) && charges_first()) return;
    const Goal here = errands_.goals().front();
    way_.append({here.transfer, FP_NONE, here.order});
    errands_.reached(1);
  }
  if (now_s() < plan_after_s_) return;
  if (charging_ || way_.contains(Leg::Kind::Charge)) {
    if (charging_ && right_of_way_.is_asked_for(protocol_.own_held()) &&
        settings_.is_enough(controller_.battery_level()))
      plan_making_way();
  } else if (!errands_.empty()) {
    plan_transport();
  } else if (is_idle()) {
    plan_making_way();
  }
}

void HullLock::plan_transport() {
  if (way_.time_left_s(protocol_.held().heading, now_s()) > locking_takes_s_ + braking_s_ && !must_lock_first()) return;
  seniority_.raise(controller_.now_ns());
  request(way_on(), Purpose::Transport);
}

// An AGV without transports leaves a place that another AGV asks for. It also leaves a place that is not safe to wait
// at.
void HullLock::plan_making_way() {
  const bool asked = right_of_way_.is_asked_for(protocol_.own_held());
  if (!asked && (planner_.places().is_safe(protocol_.held().station) || now_s() - started_s_ < 2.0)) return;
  if (asked) controller_.sometimes("makes-way");
  request(way_out(Yields::ToAll), Purpose::MakeWay);
}

Section HullLock::way_out(Yields to) {
  if (!options_.progress.makes_way) return {};
  const auto goes_first = [&](std::uint32_t agv, const Neighbour& n) {
    return right_of_way_.goes_first(to, seniority_.since_ns(), agv, n);
  };
  return planner_.out_of_the_way(end_of(map_, protocol_.held()), budget(), carries_load(errands_.goals()), is_idle(),
                                 controller_.random(kPlaceDraws), goes_first);
}

void HullLock::request(Section section, Purpose purpose, std::int64_t demand_ns) {
  if (section.empty()) {
    plan_after_s_ = now_s() + kRetryPlanning_s;
    return;
  }
  if (purpose == Purpose::Transport) section.onward = planner_.way_on_from(section, goals_now());
  if (!options_.progress.whole_sections) cut_after_first_lane(section);
  section_ = std::move(section);
  purpose_ = purpose;
  requested_at_s_ = now_s();
  if (demand_ns < 0) demand_ns = seniority_.since_ns();
  if (!protocol_.request(section_.path, demand_ns < 0 ? controller_.now_ns() : demand_ns, section_.onward))
    plan_after_s_ = now_s() + kRetryPlanning_s;
}

// If the AGV waits for an AGV that only waits itself, it looks for another way. In the end it makes way.
void HullLock::reconsider() {
  if (!protocol_.requesting() || !is_waiting() || out_of_order_ || !is_time_to_reconsider()) return;
  if (!protocol_.is_held(protocol_.requested())) return;
  const Purpose purpose = errands_.empty() ? Purpose::MakeWay : Purpose::Transport;
  Section other = purpose == Purpose::Transport ? way_on() : way_out(Yields::ToAll);
  if (!other.empty() && !(other.path == protocol_.requested()) && !protocol_.is_held(other.path)) {
    controller_.sometimes("another-way-round");
    return request(std::move(other), purpose);
  }
  if (protocol_.waiting_inside(protocol_.requested()) == FP_NONE) return;
  const Yields to = right_of_way_.when_blocked(protocol_.own_held(), seniority_.since_ns());
  if (to == Yields::ToNobody) return;
  Section retreat = way_out(to);
  if (retreat.empty() || retreat.path == protocol_.requested()) return;
  controller_.sometimes("retreat");
  const std::int64_t eldest_ns = right_of_way_.eldest_demand_ns(protocol_.own_held(), seniority_.since_ns());
  if (to == Yields::ToAll) seniority_.stand_back(controller_.now_ns());
  request(std::move(retreat), Purpose::MakeWay, to == Yields::ToElders ? eldest_ns : -1);
}

void* create_hull_lock(const fp_host* host, fp_controller* controller, const fp_briefing* briefing,
                       const LockOptions& options) {
  if (!has_numbers_for_all(*host, controller, *briefing)) return nullptr;
  if (!gets_own_transports(*host, controller, *briefing)) return nullptr;
  return new HullLock(*host, controller, *briefing, options);
}

constinit const fp_agent_type kHullLock = agent_type<HullLock>(
    "hull-lock", "locks the floor it is going to cover before it drives; sound under any loss and delay",
    [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
      return create_hull_lock(host, controller, briefing, {});
    });

}  // namespace fleetproof::agents
