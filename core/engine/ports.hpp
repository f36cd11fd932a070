#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/engine/agv_status.hpp"
#include "core/engine/notes.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/faults.hpp"
#include "core/sdk/fleetproof/agent.h"

// What the parts of the engine ask of each other. A part that several others call is seen by them only as a port: a
// pointer with the few functions that they need. Each function passes its call on to the part (ports.cpp) with neither
// a virtual call nor a decision, and its contract stands here or, where the words are the same, at the part.
namespace fleetproof {

class Actions;
class Activities;
class AgentHost;
class AgvController;
class Battery;
class Contacts;
class Drives;
class Declarations;
class FaultInjector;
class Halts;
class Messenger;
class OperatorActions;
class PositionSensor;
class Scanner;
class Timers;

class BatteryPort {
 public:
  explicit BatteryPort(Battery& part) : part_(&part) {}
  // Books what the AGV has used until now. Call this before its activity changes.
  void settle(AgvId agv) const;
  // Call this after an activity has begun, changed or ended.
  void activity_changed(AgvId agv, bool drive_begins) const;
  double level(AgvId agv) const;  // 0 .. 1
  bool is_out(AgvId agv) const;
  void change(AgvId agv, double level) const;

 private:
  Battery* part_;
};

class PositionSensorPort {
 public:
  explicit PositionSensorPort(PositionSensor& part) : part_(&part) {}
  // Call this just before the AGV's piece ends.
  void piece_ends(AgvId agv) const;
  Pose perceived(AgvId agv) const;
  void forget(AgvId agv) const;

 private:
  PositionSensor* part_;
};

class MessengerPort {
 public:
  explicit MessengerPort(Messenger& part) : part_(&part) {}
  // Call this for each piece of an AGV that begins after time zero: roaming depends on the path of the AGV.
  void piece_begins(const Piece& piece) const;
  void forget_path(AgvId agv) const;
  std::optional<std::uint32_t> accept(AgvId sender, std::string_view bytes, std::uint32_t receiver) const;
  std::uint64_t hash_of(std::uint32_t slot) const;
  void transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver) const;
  void spare(std::uint32_t slot) const;
  void withdraw(std::uint32_t slot) const;
  bool read(AgvId agv, fp_message& out) const;
  std::span<const fp_message> unread(AgvId agv) const;
  void forget_inbox(AgvId agv) const;

 private:
  Messenger* part_;
};

class ActivitiesPort {
 public:
  explicit ActivitiesPort(Activities& part) : part_(&part) {}
  void begin(AgvId agv, const Activity& activity, std::uint64_t subject) const;
  void begin_moving(AgvId agv, ActivityKind kind, const Piece& piece, std::uint64_t subject) const;
  void continue_with(AgvId agv, const Piece& piece) const;
  void end(AgvId agv, bool as_planned) const;
  void end_turn_at(AgvId agv, const Vec2& heading) const;
  void end_rolling(AgvId agv) const;
  void stand(AgvId agv, const Pose& pose) const;

 private:
  Activities* part_;
};

// The lanes that an AGV drives or is going to drive, each null if there is none.
struct LanesAhead {
  const Lane* current = nullptr;  // of the action under way
  const Lane* next = nullptr;     // of the action queued behind it
  bool still_to_drive = false;    // the current lane: the drive is under way or still to begin
};

class ActionsPort {
 public:
  explicit ActionsPort(Actions& part) : part_(&part) {}
  bool accept(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const;
  void begin(AgvId agv, fp_call call, std::uint32_t segment, LoadId load) const;
  void withdraw_accepted(AgvId agv) const;
  fp_action doing(AgvId agv) const;
  LanesAhead lanes(AgvId agv) const;
  void brake(AgvId agv) const;
  void go_on(AgvId agv) const;
  void reshape(AgvId agv) const;
  bool stop_for_good(AgvId agv) const;
  void put_back(AgvId agv, StationId station) const;

 private:
  Actions* part_;
};

class HaltsPort {
 public:
  explicit HaltsPort(Halts& part) : part_(&part) {}
  std::uint64_t begin(AgvId agv, Halt::Reason reason) const;
  void end(AgvId agv, std::uint64_t number) const;
  void end_all(AgvId agv, Halt::Reason reason) const;
  void forget(AgvId agv) const;

 private:
  Halts* part_;
};

class TimersPort {
 public:
  explicit TimersPort(Timers& part) : part_(&part) {}
  std::int64_t now_ns(AgvId agv) const;
  void set(AgvId agv, std::uint32_t number, std::int64_t at_ns) const;
  void forget(AgvId agv) const;

 private:
  Timers* part_;
};

class AgentHostPort {
 public:
  explicit AgentHostPort(AgentHost& part) : part_(&part) {}
  void tell(AgvId agv, const fp_event& event) const;
  bool is_up(AgvId agv) const;
  bool has_events_waiting(AgvId agv) const;
  void freeze_until(AgvId agv, SimTime until) const;
  void goes_away(AgvId agv) const;
  void comes_back(AgvId agv) const;
  std::optional<Denial> why_not_told(AgvId agv, const std::string& word) const;
  void tell_fault(AgvId agv, const Fault& fault) const;

 private:
  AgentHost* part_;
};

}  // namespace fleetproof
