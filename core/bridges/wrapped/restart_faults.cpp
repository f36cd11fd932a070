// A program that begins again, and nobody is told.
#include <set>
#include <string>
#include <utility>

#include "core/bridges/wrapped/fault_agents.hpp"
#include "core/bridges/wrapped/restart_facts.hpp"

namespace fleetproof::wrapped {
namespace {

class Forgetting : public WrappedAgent {
 public:
  Forgetting(const Fault& fault, const Surroundings& around)
      : WrappedAgent(around),
        period_ns_(fault.period_ns),
        first_ns_(drawn_below(fault.period_ns, around.briefing)),
        facts_(around.briefing) {}

  std::int32_t set_timer(std::uint32_t timer, std::int64_t at_ns) override {
    if (at_ns < 0) {
      timers_.erase(timer);
    } else {
      timers_.insert(timer);
    }
    return WrappedAgent::set_timer(timer, at_ns);
  }
  void accepted(std::uint32_t segment) override { facts_.accepted(segment); }
  void works_on(std::uint32_t agv, std::uint32_t order) override { facts_.works_on(agv, order); }
  std::int32_t cannot_start(const char* why) override {
    if (is_again_ && why != nullptr) why_not_ = why;
    return WrappedAgent::cannot_start(why);
  }

 private:
  void hear(const fp_event& event) override {
    if (event.kind == FP_EVENT_START) set_own_timer(next_ns(event.now_ns));
    if (event.kind == FP_EVENT_TIMER) timers_.erase(event.timer);
    facts_.hear(event, perceived_by(*this));
    pass_on(event);
  }
  std::int64_t next_ns(std::int64_t now_ns) const {
    if (now_ns < first_ns_) return first_ns_;
    return first_ns_ + ((now_ns - first_ns_) / period_ns_ + 1) * period_ns_;
  }
  void own_timer_goes_off(std::int64_t now_ns) override {
    destroy_inside();
    for (const std::uint32_t timer : std::exchange(timers_, {})) WrappedAgent::set_timer(timer, -1);
    fp_message unread{};
    unread.struct_size = sizeof unread;
    while (host().get_message(handle(), &unread) == FP_OK) {
    }
    set_own_timer(next_ns(now_ns));
    begin_again(now_ns);
  }
  void begin_again(std::int64_t now_ns) {
    const fp_perceived seen = perceived_by(*this);
    is_again_ = true;
    if (!create_inside(facts_.briefing_now(seen))) {
      host().fail(handle(), 0, ("cannot start again" + (why_not_.empty() ? "" : ": " + why_not_)).c_str());
      return;
    }
    fp_event start{};
    start.struct_size = sizeof start;
    start.kind = FP_EVENT_START;
    start.now_ns = now_ns;
    pass_on(start);
    for (fp_event order : facts_.orders_now(seen)) {
      order.now_ns = now_ns;
      pass_on(order);
    }
  }

  std::int64_t period_ns_, first_ns_;
  RestartFacts facts_;
  std::set<std::uint32_t> timers_;  // that are set
  bool is_again_ = false;
  std::string why_not_;
};

}  // namespace

std::unique_ptr<WrappedAgent> make_forgetting(const Fault& fault, const Surroundings& around) {
  return std::make_unique<Forgetting>(fault, around);
}

}  // namespace fleetproof::wrapped
