#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/engine/agent_clock.hpp"
#include "core/motion/activity.hpp"
#include "core/motion/speed_plan.hpp"
#include "core/scenario/layout.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// A controller call that takes effect later than it was made, because thinking costs time.
struct PendingCall {
  enum class Kind : std::uint8_t { Action, Send, SafeMode, WaitingFor, Timer, Nothing } kind = Kind::Action;
  std::uint32_t what = 0;  // fp_call, receiver, flag, AGV or timer number
  std::uint32_t segment = FP_NONE;
  std::uint32_t message = 0;  // slot
  std::int64_t instant_ns = 0;
};

// What is left of an action after the activity under way: turn, drive, settle, stay.
struct Plan {
  fp_call call = FP_CALL_MOVE;
  const Lane* lane = nullptr;
  bool drive_due = false, settle_due = false, stay_due = false;
  double way_m = 0.0;  // along the lane: where the drive goes on that a halt has cut short
};

// An action accepted while the AGV was still on its way to the station at which it begins.
struct NextAction {
  fp_call call = FP_CALL_MOVE;
  const Lane* lane = nullptr;
};

// The drive under way, in legs. The first of them to be driven is under way.
struct DriveState {
  std::vector<Leg> legs;
  std::size_t leg = 0;
  MotionLimits limits;  // of the load, and with the deviation drawn for this drive
};

// Why an AGV brakes and stands, wherever it is.
struct Halt {
  enum class Reason : std::uint8_t { ProtectiveStop, Scanner, Breakdown, EmptyBattery } reason = Reason::ProtectiveStop;
  std::uint64_t number = 0;
  bool out_of_order() const { return reason == Reason::Breakdown || reason == Reason::EmptyBattery; }
};

// The energy book, in shares of a full battery.
struct BatteryBook {
  double driven = 0.0, idled = 0.0, charged = 0.0;
};

struct Timer {
  std::uint32_t number = 0;
  std::uint64_t stamp = 0;  // 0: cleared
};

// One AGV with its controller and the computer its agent runs on.
struct Agv {
  AgvId id;
  StationId station;                 // where it stands, or the last it left
  bool out_of_order = false;         // for good, or until the operator has set it down somewhere else
  const Lane* stopped_on = nullptr;  // then: the lane on which it stands; null: it stands at its station
  bool acting = false;               // an action is under way
  bool committed = false;            // or one has been accepted and is about to take effect
  std::optional<Activity> activity;
  Plan plan;
  std::optional<NextAction> next;
  DriveState drive;
  std::uint32_t drives = 0, stays = 0;  // begun in this run: they number the draws of the motion stream
  double driven_m = 0.0;
  std::vector<Halt> halts;  // it stands while there is any
  std::uint64_t halts_ever = 0;
  bool plan_waits = false;           // for the end of its halts
  std::uint64_t activity_stamp = 0;  // tells an ActivityEnds event of the current activity from a stale one
  fp_action doing = FP_IDLE;
  SimTime last_progress = kStart;  // an action begun or ended, or the agent restarted by the operator

  double battery = 1.0;  // as of battery_at
  SimTime battery_at = kStart;
  double battery_way_m = 0.0;       // along the drive under way, as of battery_at
  bool battery_out = false;         // empty, until the operator has changed it
  std::uint64_t battery_stamp = 0;  // tells a BatteryEmpty event that still holds from a stale one
  BatteryBook book;

  std::uint64_t scanner_stamp = 0;
  bool scanner_muted = false;  // by the operator, until the field is clear
  double field_m =
      0.0;  // length of the field when it stopped the AGV, and where that was: so much has to be clear again
  Vec2 field_from_m = Vec2::Zero();
  std::optional<SimTime> field_clear_since;
  std::uint32_t assists = 0;

  std::vector<std::uint32_t> inbox;  // message slots, oldest first, from inbox_read on
  std::size_t inbox_read = 0;
  std::uint32_t message_in_hand = FP_NONE;
  std::vector<Timer> timers;
  std::uint64_t timer_stamp = 0;
  SimTime last_sent = SimTime::min();
  std::uint32_t sent_at_that_instant = 0;

  // The agent's clock.
  void* agent = nullptr;
  bool agent_failed = false;
  std::uint32_t agent_away = 0;  // for so many reasons: a restart, the AGV off the floor
  std::uint32_t boot = 0;
  bool in_activation = false;
  bool wake_scheduled = false;
  SimTime free_at = kStart;
  Duration cost{};
  std::uint32_t calls = 0;  // in this activation
  std::uint32_t activations_at_instant = 0;
  std::uint64_t activations = 0;  // in this run
  SimTime last_activation = SimTime::min();
  std::deque<fp_event> waiting_events;  // arrived while the agent was busy
  std::deque<PendingCall> pending_calls;

  AgentClock clock;
  std::deque<Piece> past;  // pieces that a late position still looks back at

  std::optional<SimTime> safe_since;
  std::uint64_t safe_mode_ns = 0;
};

}  // namespace fleetproof
