#include "core/bridges/wrapped/wrapped_agent.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/sdk/agent_table.hpp"

namespace fleetproof::wrapped {

// While it lives, the agent inside is called on this thread.
class WrappedAgent::Called {
 public:
  explicit Called(WrappedAgent& agent) : agent_(agent) { agent_.thread_.store(std::this_thread::get_id()); }
  ~Called() { agent_.thread_.store({}); }
  Called(const Called&) = delete;
  Called& operator=(const Called&) = delete;

 private:
  WrappedAgent& agent_;
};

bool WrappedAgent::start() {
  const Called called(*this);
  return create_inside(briefing());
}

void WrappedAgent::tell(const fp_event& event) {
  const Called called(*this);
  if (event.kind == FP_EVENT_TIMER && event.timer == around_.own_timer) return own_timer_goes_off(event.now_ns);
  hear(event);
}

void WrappedAgent::end() {
  const Called called(*this);
  destroy_inside();
}

void WrappedAgent::pass_on(fp_event event) {
  event.now_ns = shown_ns(event.now_ns);
  if (agent_ != nullptr) around_.inside.on_event(agent_, &event);
}

bool WrappedAgent::create_inside(const fp_briefing& briefing) {
  agent_ = create_agent(around_.inside, &kHostInside, reinterpret_cast<fp_controller*>(this), &briefing);
  return agent_ != nullptr;
}

void WrappedAgent::destroy_inside() {
  if (void* agent = std::exchange(agent_, nullptr)) around_.inside.destroy(agent);
}

std::int32_t WrappedAgent::set_timer(std::uint32_t timer, std::int64_t at_ns) {
  if (timer == around_.own_timer) {
    const std::string why =
        "sets timer " + std::to_string(timer) + ", which a fault around the program uses; choose a small number";
    host().fail(handle(), 0, why.c_str());
    return FP_SUSPENDED;
  }
  return host().set_timer(handle(), timer, at_ns < 0 ? at_ns : std::max<std::int64_t>(0, own_ns(at_ns)));
}

fp_perceived perceived_by(const WrappedAgent& agent) {
  fp_perceived seen{};
  seen.struct_size = sizeof seen;
  seen.order_id = FP_NONE;
  agent.host().perceive(agent.handle(), &seen);
  return seen;
}

// The finaliser of SplitMix64.
std::int64_t drawn_below(std::int64_t end, const fp_briefing& briefing) {
  std::uint64_t bits = briefing.seed + (briefing.self + 1) * 0x9e37'79b9'7f4a'7c15U;
  bits = (bits ^ bits >> 30U) * 0xbf58'476d'1ce4'e5b9U;
  bits = (bits ^ bits >> 27U) * 0x94d0'49bb'1331'11ebU;
  bits ^= bits >> 31U;
  return end > 0 ? static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(end)) : 0;
}

namespace {

// ---- what the agent inside calls

WrappedAgent& agent_of(fp_controller* controller) { return *reinterpret_cast<WrappedAgent*>(controller); }

template <auto kMember>
struct PassedOn;

template <class Result, class... Arguments, Result (*fp_host::*kMember)(fp_controller*, Arguments...)>
struct PassedOn<kMember> {
  static Result call(fp_controller* controller, Arguments... arguments) {
    const WrappedAgent& agent = agent_of(controller);
    return (agent.host().*kMember)(agent.handle(), arguments...);
  }
};

// As PassedOn, but the agent hears of calls that are admitted.
template <auto kMember, auto kHeard>
struct Heard;

template <class Result, class... Arguments, Result (*fp_host::*kMember)(fp_controller*, Arguments...), auto kHeard>
struct Heard<kMember, kHeard> {
  static Result call(fp_controller* controller, Arguments... arguments) {
    WrappedAgent& agent = agent_of(controller);
    if (agent.admits()) return (agent.*kHeard)(arguments...);
    return (agent.host().*kMember)(agent.handle(), arguments...);
  }
};

template <auto kMember>
std::int32_t action(fp_controller* controller, std::uint32_t segment) {
  WrappedAgent& agent = agent_of(controller);
  const std::int32_t result = (agent.host().*kMember)(agent.handle(), segment);
  if (result == FP_OK && agent.admits()) agent.accepted(segment);
  return result;
}

std::int32_t pick_load(fp_controller* controller, std::uint32_t segment, std::uint32_t order) {
  WrappedAgent& agent = agent_of(controller);
  const std::int32_t result = agent.host().pick_load(agent.handle(), segment, order);
  if (result == FP_OK && agent.admits()) agent.accepted(segment);
  return result;
}

std::int32_t works_on(fp_controller* controller, std::uint32_t agv, std::uint32_t order) {
  WrappedAgent& agent = agent_of(controller);
  const std::int32_t result = agent.host().works_on(agent.handle(), agv, order);
  if (result == FP_OK && agent.admits()) agent.works_on(agv, order);
  return result;
}

std::int64_t now_ns(fp_controller* controller) {
  const WrappedAgent& agent = agent_of(controller);
  return agent.shown_ns(agent.host().now_ns(agent.handle()));
}

void believe(fp_controller* controller, std::uint32_t agv, const fp_pose* where, std::int64_t as_of_ns) {
  const WrappedAgent& agent = agent_of(controller);
  agent.host().believe(agent.handle(), agv, where, agent.own_ns(as_of_ns));
}

std::int32_t perceive(fp_controller* controller, fp_perceived* out) {
  WrappedAgent& agent = agent_of(controller);
  const std::int32_t result = agent.admits() ? agent.perceive(out) : agent.host().perceive(agent.handle(), out);
  if (result == FP_OK) out->now_ns = agent.shown_ns(out->now_ns);
  return result;
}

}  // namespace

const fp_host kHostInside = {
    sizeof(fp_host),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    action<&fp_host::move>,
    action<&fp_host::pick>,
    action<&fp_host::drop>,
    action<&fp_host::park>,
    action<&fp_host::charge>,
    PassedOn<&fp_host::send_broadcast>::call,
    PassedOn<&fp_host::send_unicast>::call,
    Heard<&fp_host::get_position, &WrappedAgent::get_position>::call,
    PassedOn<&fp_host::get_battery_level>::call,
    Heard<&fp_host::get_message, &WrappedAgent::get_message>::call,
    PassedOn<&fp_host::is_loaded>::call,
    PassedOn<&fp_host::get_action>::call,
    now_ns,
    Heard<&fp_host::set_timer, &WrappedAgent::set_timer>::call,
    PassedOn<&fp_host::random>::call,
    PassedOn<&fp_host::declare_cost_ns>::call,
    PassedOn<&fp_host::safe_mode>::call,
    PassedOn<&fp_host::waiting_for>::call,
    PassedOn<&fp_host::sometimes>::call,
    PassedOn<&fp_host::log>::call,
    pick_load,
    PassedOn<&fp_host::get_load>::call,
    PassedOn<&fp_host::stop>::call,
    PassedOn<&fp_host::go_on>::call,
    PassedOn<&fp_host::describe>::call,
    PassedOn<&fp_host::declare_state>::call,
    believe,
    Heard<&fp_host::cannot_start, &WrappedAgent::cannot_start>::call,
    PassedOn<&fp_host::keep>::call,
    PassedOn<&fp_host::recall>::call,
    PassedOn<&fp_host::conflict>::call,
    works_on,
    PassedOn<&fp_host::declare_waiting>::call,
    PassedOn<&fp_host::fail>::call,
    perceive,
    PassedOn<&fp_host::describe_message>::call,
};

}  // namespace fleetproof::wrapped
