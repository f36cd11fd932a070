// The controller of the participants: what an agent calls, and the handle by which it calls.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/agent_call.hpp"
#include "core/engine/call_limits.hpp"
#include "core/engine/disks.hpp"
#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {
class AgvController;
class CallTape;
class ToldPlant;

// A failure that the agent has filed itself.
struct FiledFailure : AgentFailure {
  std::uint64_t calls = 0;  // of the activation until then, services among them
};
}  // namespace fleetproof

// The handle that an agent holds: which AGV or computer of which run, and what the activation under way has used so
// far.
struct fp_controller {
  fleetproof::AgvController* part = nullptr;
  fleetproof::EntityId agv;                // or computer
  bool is_computer = false;                // it has no AGV to act with
  bool hears_notes = false;                // as RunContext::hears_notes
  fleetproof::CallTape* tape = nullptr;    // takes the calls of the activation; null: nobody records them
  fleetproof::ToldPlant* plant = nullptr;  // map and fleet, as agents see them
  std::string* why_not = nullptr;          // takes why the agent cannot start; null: it is not being created
  std::unique_ptr<fleetproof::FiledFailure> failure{};  // by the agent itself; null: none
  fleetproof::Duration cost{};                          // of its calls
  std::uint64_t calls = 0, services = 0;                // so many
  std::uint64_t calls_max = 0;                          // so many are admitted; none outside an activation

  bool in_activation() const { return calls_max > 0; }
  // Which limit the agent has exceeded, in words; null: none.
  const char* broken_limit() const {
    return calls > fleetproof::kCallsMax         ? "10 000 controller calls in one activation"
           : services > fleetproof::kServicesMax ? "ten million calls of random and now_ns in one activation"
                                                 : nullptr;
  }
};

namespace fleetproof {

// The controller of each AGV as its agent uses it: which calls are admitted, what they cost, and when they take effect.
// A call takes effect at the instant of the activation plus the costs so far; if that is later, the call is pending.
// controller_table.cpp translates the C interface into the functions under "calls".
class AgvController {
 public:
  struct Ports {
    ActionsPort actions;
    BatteryPort battery;
    Declarations& declarations;
    Disks& disks;
    HaltsPort halts;
    MessengerPort messenger;
    PositionSensorPort sensor;
    TimersPort timers;
  };
  AgvController(RunContext& run, const Ports& ports);

  fp_controller* handle_of(AgvId agv) { return &agv_states_[agv.index()].handle; }
  // Calls are admitted between these two only.
  void begin_activation(fp_controller& handle);
  // Whether the activation has taken time or broken a limit.
  bool end_activation(fp_controller& handle);
  // The AGV's computer goes down: pending calls, timers, inbox and declarations are lost. The disk is not.
  void forget(AgvId agv);
  // The event. Pending calls take effect in the order in which they were made.
  void call_takes_effect(AgvId agv);

  // The agent has failed. Nothing happens if it has said so before.
  static void fail(fp_controller& handle, bool hang, std::string_view text);

  // ---- calls
  // Counts the call and its cost. False: the call is not carried out.
  bool admit(fp_controller& handle);
  // The same for `random` and `now_ns`, which have a limit of their own: they neither act nor perceive.
  bool admit_service(fp_controller& handle);
  // The same for notes, which do not count as calls. Requires: somebody hears them.
  bool admit_note(AgvId agv);
  // So many calls of `admit_service`, and of `admit` when its limit is reached, in one.
  void admit_services(AgvId agv, std::uint64_t count);
  void refuse(AgvId agv, std::uint64_t count);
  // `load`: named for a pick.
  std::int32_t act(AgvId agv, fp_call call, std::uint32_t segment, LoadId load = {});
  std::int32_t pick_load(AgvId agv, std::uint32_t segment, std::uint32_t order);
  // `on`: it stops, else it goes on.
  std::int32_t stop(AgvId agv, bool on);
  std::int32_t send(AgvId agv, std::string_view bytes, std::uint32_t receiver);
  std::int32_t set_timer(AgvId agv, std::uint32_t number, std::int64_t at_ns);
  std::int32_t declare_safe_mode(AgvId agv, bool on);
  // Of an AGV, by its own agent or by the program of a computer.
  std::int32_t declare_waiting(EntityId speaker, std::uint32_t agv, std::uint32_t other);
  std::int32_t works_on(EntityId speaker, std::uint32_t agv, std::uint32_t order);
  std::int32_t declare_cost(AgvId agv, std::int64_t cost_ns);
  std::int32_t keep(AgvId agv, std::uint32_t number, DiskRecord record);
  // Perceptions and notes are passed on as they are.
  const Ports& ports() const { return ports_; }
  std::uint32_t order_on_board(AgvId agv) const;  // FP_NONE: no load
  std::uint64_t random(AgvId agv, std::uint32_t purpose, std::uint64_t index) const;

 private:
  struct PendingCall {
    enum class Kind : std::uint8_t {
      Action,
      Stop,
      Send,
      SafeMode,
      WaitingFor,
      WorksOn,
      Timer,
      Keep,
      Nothing
    } kind = Kind::Action;
    std::uint32_t what = 0;  // fp_call, receiver, flag, AGV, order or timer number
    std::uint32_t segment = FP_NONE;
    LoadId load{};
    std::uint32_t message = 0;  // slot
    AgvId about{};              // of a declaration that a computer may make, too
    std::int64_t instant_ns = 0;
  };
  struct AgvState {
    fp_controller handle;
    std::list<PendingCall> pending;  // a list: none need no memory
    void put_off(RunContext& run, const PendingCall& call);
  };
  // Carries the call out now, or later if the calls before it have cost time.
  [[gnu::always_inline]] std::int32_t take_effect(AgvId agv, const PendingCall& call);
  [[gnu::always_inline]] void carry_out(AgvId agv, const PendingCall& call);
  void apply_stop(AgvId agv, bool on);

  RunContext& run_;
  Ports ports_;
  Duration call_cost_;
  std::uint64_t random_key_;
  std::vector<AgvState> agv_states_;  // by participant
};

}  // namespace fleetproof
