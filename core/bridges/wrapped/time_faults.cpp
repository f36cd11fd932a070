// What comes late or shows another time: events, positions, clocks.
#include <algorithm>
#include <deque>
#include <vector>

#include "core/bridges/wrapped/fault_agents.hpp"

namespace fleetproof::wrapped {
namespace {

class Stalling : public WrappedAgent {
 public:
  Stalling(const Fault& fault, const Surroundings& around)
      : WrappedAgent(around),
        length_ns_(fault.length_ns),
        period_ns_(fault.period_ns),
        first_ns_(drawn_below(fault.period_ns, around.briefing)) {}

 private:
  // The end of the stall under way; 0: none is.
  std::int64_t end_of_stall(std::int64_t now_ns) const {
    if (now_ns < first_ns_) return 0;
    const std::int64_t into_ns = (now_ns - first_ns_) % period_ns_;
    return into_ns < length_ns_ ? now_ns - into_ns + length_ns_ : 0;
  }
  void hear(const fp_event& event) override {
    const std::int64_t end_ns = end_of_stall(event.now_ns);
    if (end_ns == 0) {
      release(event.now_ns);
      return pass_on(event);
    }
    // What a starting agent is told of its place holds at that instant.
    if (event.kind == FP_EVENT_START) return pass_on(event);
    if (held_.empty()) set_own_timer(end_ns);
    const bool is_heard_already =
        (event.kind == FP_EVENT_MESSAGE || event.kind == FP_EVENT_TIMER) &&
        std::ranges::any_of(held_, [&](const fp_event& other) {
          return other.kind == event.kind && (event.kind == FP_EVENT_MESSAGE || other.timer == event.timer);
        });
    if (!is_heard_already) held_.push_back(event);
  }
  void own_timer_goes_off(std::int64_t now_ns) override {
    const std::int64_t end_ns = end_of_stall(now_ns);
    if (end_ns != 0) return set_own_timer(end_ns);
    release(now_ns);
  }
  void release(std::int64_t now_ns) {
    std::vector<fp_event> held;
    held.swap(held_);
    for (fp_event& event : held) {
      event.now_ns = now_ns;
      pass_on(event);
    }
  }

  std::int64_t length_ns_, period_ns_, first_ns_;
  std::vector<fp_event> held_;
};

class OldPosition : public WrappedAgent {
 public:
  OldPosition(const Fault& fault, const Surroundings& around) : WrappedAgent(around), age_ns_(fault.length_ns) {}

  std::int32_t get_position(fp_pose* out) override {
    const std::int32_t result = host().get_position(handle(), out);
    if (result == FP_OK) *out = old_one(perceived_by(*this));
    return result;
  }
  std::int32_t perceive(fp_perceived* out) override {
    const std::int32_t result = host().perceive(handle(), out);
    if (result == FP_OK && briefing().role == FP_AGV) out->pose = old_one(*out);
    return result;
  }

 private:
  // Between events nobody sees the AGV, so the own timer looks.
  void hear(const fp_event& event) override {
    if (briefing().role == FP_AGV) {
      look();
      if (event.kind == FP_EVENT_START) set_own_timer(event.now_ns + look_every_ns());
    }
    pass_on(event);
  }
  void own_timer_goes_off(std::int64_t now_ns) override {
    look();
    set_own_timer(now_ns + look_every_ns());
  }
  std::int64_t look_every_ns() const { return std::max<std::int64_t>(1, age_ns_ / 8); }
  void look() { old_one(perceived_by(*this)); }
  // The newest of those that are old enough; none is: the oldest.
  const fp_pose& old_one(const fp_perceived& seen) {
    if (seen_.empty() || seen_.back().at_ns < seen.now_ns) seen_.push_back({seen.now_ns, seen.pose});
    while (seen_.size() > 1 && seen_[1].at_ns <= seen.now_ns - age_ns_) seen_.pop_front();
    return seen_.front().pose;
  }

  struct Seen {
    std::int64_t at_ns;
    fp_pose pose;
  };
  std::int64_t age_ns_;
  std::deque<Seen> seen_;  // oldest first
};

class ClockOff : public WrappedAgent {
 public:
  ClockOff(const Fault& fault, const Surroundings& around)
      : WrappedAgent(around), ahead_ns_(drawn_below(fault.length_ns, around.briefing) + 1) {}

  std::int64_t shown_ns(std::int64_t own_ns) const override { return own_ns + ahead_ns_; }
  std::int64_t own_ns(std::int64_t shown_ns) const override { return shown_ns - ahead_ns_; }

 private:
  std::int64_t ahead_ns_;
};

}  // namespace

std::unique_ptr<WrappedAgent> make_stalling(const Fault& fault, const Surroundings& around) {
  return std::make_unique<Stalling>(fault, around);
}

std::unique_ptr<WrappedAgent> make_old_position(const Fault& fault, const Surroundings& around) {
  return std::make_unique<OldPosition>(fault, around);
}

std::unique_ptr<WrappedAgent> make_clock_off(const Fault& fault, const Surroundings& around) {
  return std::make_unique<ClockOff>(fault, around);
}

}  // namespace fleetproof::wrapped
