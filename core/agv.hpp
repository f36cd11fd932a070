#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/activity.hpp"
#include "core/layout.hpp"
#include "core/sdk/fleetproof/agent.h"
#include "core/sim_time.hpp"

namespace fleetproof {

// A controller call that takes effect later than it was made, because thinking costs time.
struct PendingCall {
  enum class Kind : std::uint8_t { Action, Send, SafeMode, WaitingFor, Timer } kind = Kind::Action;
  std::uint32_t what = 0;      // fp_call, receiver, flag, AGV or timer number
  std::uint32_t segment = FP_NONE;
  std::uint32_t message = 0;   // slot
  std::int64_t instant_ns = 0;
};

// What is left of an action after the activity under way: turn, then drive, then stay.
struct Plan {
  fp_call call = FP_CALL_MOVE;
  const Lane* lane = nullptr;
  bool drive_due = false, stay_due = false;
};

struct Timer {
  std::uint32_t number = 0;
  std::uint64_t stamp = 0;     // 0: cleared
};

// One AGV with its controller and the computer its agent runs on.
struct Agv {
  AgvId id;
  StationId station;                   // where it stands, or the last it left
  double battery = 1.0;
  bool out_of_order = false;
  bool committed = false;              // an accepted action is under way or about to take effect
  std::optional<Activity> activity;
  Plan plan;
  std::uint64_t activity_stamp = 0;    // tells an ActivityEnds event of the current activity from a stale one
  fp_action doing = FP_IDLE;

  std::vector<std::uint32_t> inbox;    // message slots, oldest first, from inbox_read on
  std::size_t inbox_read = 0;
  std::uint32_t message_in_hand = FP_NONE;
  std::vector<Timer> timers;
  std::uint64_t timer_stamp = 0;
  SimTime last_sent = SimTime::min();
  std::uint32_t sent_at_that_instant = 0;

  // The agent's clock.
  void* agent = nullptr;
  bool agent_failed = false;
  bool in_activation = false;
  bool wake_scheduled = false;
  SimTime free_at = kStart;
  Duration cost{};
  std::uint32_t calls = 0;             // in this activation
  std::uint32_t activations_at_instant = 0;
  std::uint64_t activations = 0;       // in this run
  SimTime last_activation = SimTime::min();
  std::deque<fp_event> waiting_events; // arrived while the agent was busy
  std::deque<PendingCall> pending_calls;

  std::optional<SimTime> safe_since;
  std::uint64_t safe_mode_ns = 0;
};

}  // namespace fleetproof
