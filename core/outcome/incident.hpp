#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/outcome/end_point.hpp"

namespace fleetproof {

// What a law may find besides pairs that were too close. The numbers are stored: never renumber, only append.
enum class IncidentKind : std::uint32_t {
  BatteryEmpty = 1,
  ChannelSaturated = 2,
  InterferenceLosses = 3,
  LoadHeldByTwo = 4,
  LoadVanished = 5,
  LoadDeliveredTwice = 6,
  LoadPickedByFullAgv = 7,
  LoadAtWrongStation = 8,
  LoadMovedByNobody = 9,
  Deadlock = 10,
  WaitsDeclared = 11,
  WaitsInferred = 12,
  Livelock = 13,
  Starvation = 14,
  SafeModeInContract = 15,
  StandstillInContract = 16,
  ThroughputBelowFloor = 17,
  FaultInjected = 18,
  ForeignBody = 19,
  FaultWithoutEffect = 20,
  LoadDidNotFall = 21,
  ObstacleWithoutRoom = 22,
  CallNotMade = 23,
  NotReached = 24,
  MessageNotSent = 25,
  CallWithoutEffect = 26,
  OrderNotTaken = 27,
};

// What an incident says about the fleet.
enum class IncidentRole : std::uint8_t {
  Accusation,  // the fleet did something wrong
  Link,        // a part of an accusation, filed beside it: who waits for whom in a deadlock
  Condition,   // what the scenario did to the fleet; accuses nobody
  Denied,      // what the scenario asked for and did not get; accuses nobody
};

// All that is known of a kind: its role, the end point that a run with such an incident fails (absent: none), its name,
// the unit of `value`, and what an incident of the kind means, for pages and the archive's views.
struct IncidentKindInfo {
  IncidentKind kind;
  IncidentRole role;
  std::optional<EndPoint> end_point;
  std::string_view name, unit, meaning;
};
std::span<const IncidentKindInfo> incident_kinds();  // in order of their numbers, without gaps
const IncidentKindInfo& info_of(IncidentKind kind);
bool is_incident_kind(std::uint32_t number);
bool accuses(IncidentKind kind);  // an accusation, or a part of one
bool is_link(IncidentKind kind);
bool is_condition(IncidentKind kind);

// Something that a law found. `a` and `b` are the bodies concerned, each invalid if there is none.
struct Incident {
  IncidentKind kind = IncidentKind::BatteryEmpty;
  EntityId a, b;
  SimTime first{}, last{};
  std::int64_t value = 0;  // in the unit of the kind

  friend bool operator==(const Incident&, const Incident&) = default;
};

// Of an incident FaultInjected or FaultWithoutEffect: the kind of the fault, in the words of a scenario.
std::string_view fault_word(const Incident& incident);
bool is_load_drop(const Incident& incident);
// Of an incident ForeignBody: a load that fell, not an obstacle.
inline constexpr std::int64_t kObstacle = 0, kFallenLoad = 1;  // its values
bool is_fallen_load(const Incident& incident);

// Of an incident LoadDidNotFall: why. Of an incident ObstacleWithoutRoom: whether the obstacle never came.
inline constexpr std::int64_t kNoSuchLoad = 1, kNoRoomForLoad = 2, kCameLater = 0, kNeverCame = 1;  // their values

// The instant from which the incident was there without doubt. A livelock or starvation is dated from the last
// progress, long before anybody could call it one: whatever happens until its end may be its cause.
SimTime surely_began(const Incident& incident);

}  // namespace fleetproof
