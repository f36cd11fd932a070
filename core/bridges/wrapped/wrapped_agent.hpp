// An agent between the engine and an agent inside. It passes on what either says to the other; each fault overrides
// what it disturbs.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::wrapped {

// The timer of the innermost fault around a program; that of the next one outside is one less.
inline constexpr std::uint32_t kInnermostTimer = 0xffff'fff0U;

// Where an agent stands in the engine.
struct Surroundings {
  const fp_agent_type& inside;
  const fp_host& host;
  fp_controller* handle;
  const fp_briefing& briefing;
  std::uint32_t own_timer;
  void* program;  // whose agent it is
};

class WrappedAgent {
 public:
  explicit WrappedAgent(const Surroundings& around) : around_(around) {}
  virtual ~WrappedAgent() = default;
  WrappedAgent(const WrappedAgent&) = delete;
  WrappedAgent& operator=(const WrappedAgent&) = delete;

  // ---- called by the engine
  // False: the program inside cannot start.
  bool start();
  void tell(const fp_event& event);
  // The agent inside ends. Calls that it makes from here on are refused by the engine.
  void end();

  void* program() const { return around_.program; }

  // ---- called by the agent inside. What is not here is passed on as it is.
  const fp_host& host() const { return around_.host; }
  fp_controller* handle() const { return around_.handle; }
  // Whether it calls while it is called, and from the same thread; else the engine hears of the call as it is.
  bool admits() const { return thread_.load() == std::this_thread::get_id(); }
  virtual std::int32_t get_message(fp_message* out) { return host().get_message(handle(), out); }
  virtual std::int32_t get_position(fp_pose* out) { return host().get_position(handle(), out); }
  virtual std::int32_t perceive(fp_perceived* out) { return host().perceive(handle(), out); }
  // What its clock shows when the own clock shows this, and the reverse.
  virtual std::int64_t shown_ns(std::int64_t own_ns) const { return own_ns; }
  virtual std::int64_t own_ns(std::int64_t shown_ns) const { return shown_ns; }
  virtual std::int32_t set_timer(std::uint32_t timer, std::int64_t at_ns);
  // The AGV has accepted an action to this segment.
  virtual void accepted(std::uint32_t /*segment*/) {}
  virtual void works_on(std::uint32_t /*agv*/, std::uint32_t /*order*/) {}
  virtual std::int32_t cannot_start(const char* why) { return host().cannot_start(handle(), why); }

 protected:
  const fp_briefing& briefing() const { return around_.briefing; }
  // An event, as of the own clock. The usual way is to pass it on.
  virtual void hear(const fp_event& event) { pass_on(event); }
  virtual void own_timer_goes_off(std::int64_t /*now_ns*/) {}
  void pass_on(fp_event event);
  bool create_inside(const fp_briefing& briefing);
  void destroy_inside();
  void set_own_timer(std::int64_t at_ns) const { host().set_timer(handle(), around_.own_timer, at_ns); }

 private:
  class Called;
  Surroundings around_;
  void* agent_ = nullptr;
  std::atomic<std::thread::id> thread_{};  // on which it is being called; none: it is not
};

// What the agent perceives, read ahead.
fp_perceived perceived_by(const WrappedAgent& agent);
// From 0 on and below `end`: the same for a participant in every boot, and another one in another run.
std::int64_t drawn_below(std::int64_t end, const fp_briefing& briefing);

// What the agent inside is given as its host: its fp_controller is a WrappedAgent.
extern const fp_host kHostInside;

}  // namespace fleetproof::wrapped
