// Control software as straight-line code, as it runs on a real vehicle computer:
//
//   while (true) {
//     const Order order = agv.wait_order();
//     ...
//     if (agv.move(segment) != FP_OK) ...
//     if (const auto message = agv.wait_message(2s)) ...
//   }
//
// A program is a function. It runs on a stack of its own (a fiber). A call that waits leaves that stack until an event
// comes for which it waits; meanwhile simulated time passes. core/sdk/straight-line.md tells how calls map to events.
// Who includes this header links boost_context, and compiles with exceptions.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "agent.h"
#include "fiber.hpp"

namespace fleetproof::blocking {

inline constexpr std::size_t kUsualStackBytes = 256 * 1024;

namespace detail {

// How many programs caught the end of their run and did not let it pass. Hidden: each shared object has its own.
[[gnu::visibility("hidden")]] inline std::atomic<std::uint64_t>& abandoned_programs() {
  static std::atomic<std::uint64_t> count{0};
  return count;
}

struct RunEnds {};  // thrown where a program waits when its run ends, so that its objects are freed

}  // namespace detail

struct Order {
  std::uint32_t id, from, to;  // to fetch at one station, and to bring to the other
};

struct Message {
  std::uint32_t sender = FP_NONE;
  std::vector<std::byte> bytes;

  // The content, if the message has just its size.
  template <class Content>
  std::optional<Content> as() const {
    static_assert(std::is_trivially_copyable_v<Content>);
    if (bytes.size() != sizeof(Content)) return std::nullopt;
    Content content;
    std::memcpy(&content, bytes.data(), sizeof content);
    return content;
  }
};

// What a program waits for, or-ed; and what an event is.
enum Kind : std::uint32_t {
  kTimeIsUp = 0,  // nothing has come in time
  kOrder = 1u << FP_EVENT_ORDER,
  kMessage = 1u << FP_EVENT_MESSAGE,
  kDone = 1u << FP_EVENT_ACTION_DONE,
  kFault = 1u << FP_EVENT_FAULT,
  kWithdrawn = 1u << FP_EVENT_WITHDRAWN,
  kAnything = kOrder | kMessage | kDone | kFault | kWithdrawn
};

struct Event {
  Kind kind = kTimeIsUp;
  fp_event told{};  // with its members for this kind: result, order_id, ...
  Message message;  // of kMessage

  Order order() const { return {told.order_id, told.from, told.to}; }
};

using Duration = std::chrono::nanoseconds;
inline constexpr Duration kForever = Duration::max();

// The AGV controller, or what a computer has of it. Durations and instants are those of the participant's own clock. A
// call that waits returns in a later activation; all others take effect as agent.h says. A call that the engine refuses
// with FP_SUSPENDED does not return.
class Controller {
 public:
  Controller(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : host_(host), handle_(handle), briefing_(briefing) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  const fp_briefing& briefing() const { return briefing_; }
  Duration now() const { return Duration(now_ns_); }

  // ---- waits. What comes while a program does not wait for it is kept, and returned by a later wait, oldest first. A
  // timeout of 0 or less: what comes at this instant before a timer that is set here and now.
  Event wait(std::uint32_t kinds, Duration timeout = kForever) {
    const std::int64_t forever_ns = kForever.count(), ns = std::max<std::int64_t>(timeout.count(), 0);
    return next(kinds, ns >= forever_ns - now_ns_ ? kNoTime : now_ns_ + ns);
  }
  void sleep(Duration duration) { wait(0, duration); }
  Order wait_order() { return wait(kOrder).order(); }
  std::optional<Order> wait_order(Duration timeout) {
    const Event event = wait(kOrder, timeout);
    return event.kind == kOrder ? std::optional(event.order()) : std::nullopt;
  }
  Message wait_message() { return wait(kMessage).message; }
  std::optional<Message> wait_message(Duration timeout) {
    Event event = wait(kMessage, timeout);
    return event.kind == kMessage ? std::optional(std::move(event.message)) : std::nullopt;
  }
  // Until no action is under way: after a restart, one of the former boot may be. Then that one is over. An AGV that
  // `stop` holds is not at rest.
  void wait_until_rest() {
    for (fp_action now = action(); now != FP_IDLE && now != FP_PARKED && now != FP_CHARGING_NOW; now = action())
      wait(kDone, std::chrono::seconds(1));
    forget_done();
  }

  // ---- actions. These return when the action has ended: FP_OK, or FP_REFUSED after a contact; or at once what the
  // controller returned if it did not accept it. They also wait for an action that was begun before.
  fp_result move(std::uint32_t segment) { return carry_out(FP_CALL_MOVE, segment); }
  fp_result pick(std::uint32_t segment) { return carry_out(FP_CALL_PICK, segment); }
  fp_result pick_load(std::uint32_t segment, std::uint32_t order) { return carry_out(FP_CALL_PICK, segment, order); }
  fp_result drop(std::uint32_t segment) { return carry_out(FP_CALL_DROP, segment); }
  fp_result park(std::uint32_t segment) { return carry_out(FP_CALL_PARK, segment); }
  fp_result charge(std::uint32_t segment) { return carry_out(FP_CALL_CHARGE, segment); }
  // Begins an action, and returns at once. If it is FP_OK, an event kDone follows.
  fp_result begin(fp_call action, std::uint32_t segment, std::uint32_t order = FP_NONE) {
    using Begin = std::int32_t (*fp_host::*)(fp_controller*, std::uint32_t);
    constexpr Begin kBegin[] = {&fp_host::move, &fp_host::pick, &fp_host::drop, &fp_host::park, &fp_host::charge};
    const std::int32_t result = action == FP_CALL_PICK && order != FP_NONE ? call(&fp_host::pick_load, segment, order)
                                                                           : call(kBegin[action], segment);
    if (result == FP_OK) ++under_way_;
    return static_cast<fp_result>(result);
  }

  // ---- messages
  void broadcast(std::span<const std::byte> bytes) {
    call(&fp_host::send_broadcast, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  }
  void send(std::span<const std::byte> bytes, std::uint32_t receiver) {
    call(&fp_host::send_unicast, bytes.data(), static_cast<std::uint32_t>(bytes.size()), receiver);
  }
  template <class Content>
  requires std::is_trivially_copyable_v<Content> &&
      (!std::is_convertible_v<Content, std::span<const std::byte>>)void broadcast(const Content& content) {
    broadcast(std::as_bytes(std::span(&content, 1)));
  }
  template <class Content>
  requires std::is_trivially_copyable_v<Content> &&
      (!std::is_convertible_v<Content, std::span<const std::byte>>)void send(const Content& content,
                                                                             std::uint32_t receiver) {
    send(std::as_bytes(std::span(&content, 1)), receiver);
  }
  // The next message of the inbox. It does not wait.
  std::optional<Message> get_message() {
    fp_message told{sizeof told, FP_NONE, 0, nullptr};
    if (call(&fp_host::get_message, &told) != FP_OK) {
      has_mail_ = false;
      return std::nullopt;
    }
    const auto* first = static_cast<const std::byte*>(told.bytes);
    return Message{told.sender, {first, first + told.size}};
  }

  // ---- perceptions
  std::optional<fp_pose> position() { return perceived<fp_pose>(&fp_host::get_position); }
  std::optional<double> battery_level() { return perceived<double>(&fp_host::get_battery_level); }
  bool is_loaded() { return perceived<std::uint32_t>(&fp_host::is_loaded).value_or(0) != 0; }
  std::uint32_t order_on_board() { return perceived<std::uint32_t>(&fp_host::get_load).value_or(FP_NONE); }
  fp_action action() {
    return static_cast<fp_action>(perceived<std::uint32_t>(&fp_host::get_action).value_or(FP_STOPPED));
  }

  // Any function of agent.h: call(&fp_host::sometimes, "deferred"). FP_INVALID if the program is older than it.
  template <class Result, class... Wanted, class... Given>
  Result call(Result (*fp_host::*function)(fp_controller*, Wanted...), Given... given) {
    const auto* place = reinterpret_cast<const char*>(&(host_.*function));
    const bool is_known = place < reinterpret_cast<const char*>(&host_) + host_.struct_size;
    if constexpr (std::is_same_v<Result, std::int32_t>) {
      if (is_ending_) return FP_SUSPENDED;
      const std::int32_t result = is_known ? (host_.*function)(handle_, given...) : std::int32_t{FP_INVALID};
      if (result == FP_SUSPENDED) next(0, kNoTime);  // nothing comes any more but the end
      return result;
    } else if constexpr (std::is_void_v<Result>) {
      if (is_known && !is_ending_) (host_.*function)(handle_, given...);
    } else {
      return is_known && !is_ending_ ? (host_.*function)(handle_, given...) : Result();
    }
  }

 private:
  template <auto kProgram, std::size_t kStackBytes>
  friend class Program;
  static constexpr std::int64_t kNoTime = -1;

  static std::uint32_t bit_of(const fp_event& event) { return event.kind < 32 ? kAnything & 1u << event.kind : 0; }

  // Takes note of an event. True: the program waits for it.
  bool hear(const fp_event& event) {
    now_ns_ = event.now_ns;
    if (event.kind == FP_EVENT_TIMER) {
      timer_ns_ = kNoTime;
      return is_time_up_ = deadline_ns_ != kNoTime && now_ns_ >= deadline_ns_;
    }
    if (event.kind == FP_EVENT_ACTION_DONE && under_way_ > 0) --under_way_;
    if (event.kind != FP_EVENT_MESSAGE) {
      if (bit_of(event) != 0) kept_.push_back(event);
    } else if (!std::exchange(has_mail_, true)) {
      mail_place_ = kept_.size();
    }
    return (wanted_ & bit_of(event)) != 0;
  }

  // The first kept event of these kinds.
  bool take(std::uint32_t kinds, Event& event) {
    const auto is_wanted = [kinds](const fp_event& kept) { return (kinds & bit_of(kept)) != 0; };
    const auto first = std::find_if(kept_.begin(), kept_.end(), is_wanted);
    const auto place = static_cast<std::size_t>(first - kept_.begin());
    if ((kinds & kMessage) != 0 && has_mail_ && mail_place_ <= place) {
      if (auto message = get_message()) {
        event.kind = kMessage;
        event.message = *std::move(message);
        return true;
      }
    }
    if (first == kept_.end()) return false;
    event.kind = static_cast<Kind>(bit_of(*first));
    event.told = *first;
    kept_.erase(first);
    if (place < mail_place_) --mail_place_;
    return true;
  }
  void forget_done() {
    for (std::size_t i = kept_.size(); i-- > 0;) {
      if (kept_[i].kind != FP_EVENT_ACTION_DONE) continue;
      kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(i));
      if (i < mail_place_) --mail_place_;
    }
  }

  // The first event of these kinds, or kTimeIsUp at the deadline. All waits end here.
  Event next(std::uint32_t kinds, std::int64_t deadline_ns) {
    if (is_ending_) fiber_->leave(true);  // the program has caught the end of its run
    Event event;
    if (take(kinds, event)) return event;
    if (deadline_ns != kNoTime && std::exchange(timer_ns_, deadline_ns) != deadline_ns)
      call(&fp_host::set_timer, 0u, deadline_ns);
    wanted_ = kinds;
    deadline_ns_ = deadline_ns;
    is_time_up_ = false;
    do {
      can_end_ = std::uncaught_exceptions() == 0;  // an exception that leaves a destructor would end the process
      fiber_->leave();
      if (is_ending_) throw detail::RunEnds();
    } while (!take(kinds, event) && !is_time_up_);
    wanted_ = 0;
    deadline_ns_ = kNoTime;
    return event;
  }

  fp_result carry_out(fp_call action, std::uint32_t segment, std::uint32_t order = FP_NONE) {
    const fp_result result = begin(action, segment, order);
    if (result != FP_OK) return result;
    forget_done();
    while (true) {
      const Event done = wait(kDone);
      if (under_way_ == 0) return static_cast<fp_result>(done.told.result);
    }
  }

  template <class Value>
  std::optional<Value> perceived(std::int32_t (*fp_host::*function)(fp_controller*, Value*)) {
    Value value{};
    return call(function, &value) == FP_OK ? std::optional(value) : std::nullopt;
  }

  const fp_host& host_;
  fp_controller* handle_;
  const fp_briefing& briefing_;
  detail::Fiber* fiber_ = nullptr;
  std::vector<fp_event> kept_;   // what came and was not waited for, oldest first
  bool has_mail_ = false;        // an event has said that the inbox is not empty
  std::size_t mail_place_ = 0;   // before which kept event
  std::uint32_t wanted_ = 0;     // the kinds for which the program waits
  std::uint32_t under_way_ = 0;  // actions of this boot
  std::int64_t now_ns_ = 0, deadline_ns_ = kNoTime, timer_ns_ = kNoTime;
  bool is_time_up_ = false, is_ending_ = false, can_end_ = true;
};

// One program with its stack, controller and events.
template <auto kProgram, std::size_t kStackBytes>
class Program {
 public:
  Program(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle, briefing) {}
  ~Program() {
    if (!fiber_) return;
    controller_.is_ending_ = true;
    if (controller_.can_end_) fiber_->enter();
    if (!fiber_->is_over() && detail::abandoned_programs()++ == 0)
      std::fputs("a program caught the end of its run: its objects are not freed (core/sdk/straight-line.md)\n",
                 stderr);
    take_stack_back();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Throws what the program throws.
  void on_event(const fp_event& event) {
    if (event.kind == FP_EVENT_START) {
      controller_.now_ns_ = event.now_ns;
      stack_ = Stacks::here().take();
      controller_.fiber_ = &fiber_.emplace(std::span(stack_, kStackBytes), run, this);
    } else if (!fiber_ || !controller_.hear(event)) {
      return;
    }
    fiber_->enter();
    if (!fiber_->is_over()) return;
    take_stack_back();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  using Stacks = detail::StackPool<kStackBytes>;

  static void run(void* self) {
    auto& program = *static_cast<Program*>(self);
    try {
      kProgram(program.controller_);
    } catch (const detail::RunEnds&) {
    } catch (...) {
      program.failure_ = std::current_exception();
    }
  }
  void take_stack_back() {
    fiber_.reset();
    Stacks::here().give_back(stack_);
  }

  Controller controller_;
  std::byte* stack_ = nullptr;
  std::optional<detail::Fiber> fiber_;  // none: the program has not begun, or has ended
  std::exception_ptr failure_;
};

// How many programs of this shared object caught the end of their run and did not let it pass. Their objects are not
// freed. The first one is told on standard error.
inline std::uint64_t abandoned_programs() { return detail::abandoned_programs(); }

// The agent whose program is the function: void program(Controller&).
template <auto kProgram, std::size_t kStackBytes = kUsualStackBytes>
fp_agent_type agent_type(const char* name, const char* description, std::uint32_t flags = FP_DETERMINISTIC) {
  static_assert(std::is_invocable_v<decltype(kProgram), Controller&>, "a program is void program(Controller&)");
  static_assert(!std::is_nothrow_invocable_v<decltype(kProgram), Controller&>, "a run ends with an exception");
  using Own = Program<kProgram, kStackBytes>;
  fp_agent_type type{};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.abi_minor = FP_ABI_MINOR;
  type.flags = flags;
  type.name = name;
  type.description = description;
  type.create = [](const fp_host* host, fp_controller* handle, const fp_briefing* briefing) -> void* {
    return new Own(*host, handle, *briefing);
  };
  type.on_event = [](void* agent, const fp_event* event) { static_cast<Own*>(agent)->on_event(*event); };
  type.destroy = [](void* agent) { delete static_cast<Own*>(agent); };
  return type;
}

}  // namespace fleetproof::blocking
