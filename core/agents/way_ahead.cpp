#include "core/agents/way_ahead.hpp"

#include <algorithm>

#include "core/agents/routes.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kTransfer_s = 5.0;  // expected, of a pick or drop
constexpr double kTurn_s = 3.0;      // expected, of a turn on the spot

}  // namespace

bool WayAhead::contains(Leg::Kind kind) const {
  return (acting_ && current_.kind == kind) ||
         std::ranges::any_of(legs_, [&](const Leg& leg) { return leg.kind == kind; });
}

void WayAhead::begin(const Leg& leg, Vec heading, double now_s) {
  all_done_s_.reset();
  current_ = leg;
  acting_ = true;
  run_ = {};
  run_began_s_ = now_s;
  current_ends_s_ = now_s + (leg.kind == Leg::Kind::Drive ? 0.0 : kTransfer_s);
  if (leg.kind != Leg::Kind::Drive) return;
  if (!same_heading(heading, map_.start_heading(leg.lane))) run_began_s_ += kTurn_s;
  extend(run_, leg.lane);
  current_ends_s_ = run_began_s_ + time_s(run_);
}

bool WayAhead::can_roll_on() const {
  return acting_ && !next_is_given_ && current_.kind == Leg::Kind::Drive && !legs_.empty() &&
         next().kind == Leg::Kind::Drive &&
         same_heading(map_.end_heading(current_.lane), map_.start_heading(next().lane));
}

void WayAhead::end(double now_s) {
  acting_ = next_is_given_;
  if (!next_is_given_) return;
  next_is_given_ = false;
  const bool rolled = current_.kind == Leg::Kind::Drive;
  const Leg next = legs_.front();
  legs_.pop_front();
  if (!rolled) return begin(next, map_.start_heading(next.lane) * -1.0, now_s);
  current_ = next;
  extend(run_, next.lane);
  current_ends_s_ = run_began_s_ + time_s(run_);
}

// While a lane is driven, and when the AGV rolls on to the next one, the present does not change when all is done.
double WayAhead::time_left_s(Vec heading, double now_s) {
  if (!acting_ || current_.kind != Leg::Kind::Drive) all_done_s_.reset();
  if (!all_done_s_) all_done_s_ = work_out_end_s(heading, now_s);
  return std::max(0.0, *all_done_s_ - now_s);
}

double WayAhead::work_out_end_s(Vec heading, double now_s) const {
  Run run = acting_ ? run_ : Run{};
  double done_s = acting_ ? run_began_s_ : now_s;
  if (acting_ && current_.kind == Leg::Kind::Drive) heading = map_.end_heading(current_.lane);
  if (acting_ && current_.kind != Leg::Kind::Drive) done_s = std::max(now_s, current_ends_s_);
  for (const Leg& leg : legs_) {
    const bool drives = leg.kind == Leg::Kind::Drive;
    const bool turns = drives && !same_heading(heading, map_.start_heading(leg.lane));
    if (!drives || turns) done_s += time_s(run) + (drives ? kTurn_s : kTransfer_s), run = {};
    if (!drives) continue;
    extend(run, leg.lane);
    heading = map_.end_heading(leg.lane);
  }
  return done_s + time_s(run);
}

void WayAhead::extend(Run& run, std::uint32_t lane) const {
  const double length_m = map_.lane(lane).length_m;
  run.length_m += length_m;
  run.cruise_s += length_m / lane_speed_mps(map_, lane, self_);
}

double WayAhead::time_s(const Run& run) const {
  if (run.length_m <= 0.0) return 0.0;
  fp_agv mean = self_;
  mean.speed_mps = run.length_m / run.cruise_s;
  return drive_time_s(run.length_m, mean);
}

}  // namespace fleetproof::agents
