#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// What a law may find besides pairs that were too close. The numbers are stored: never renumber, only append. The last
// two accuse nobody: they are what the scenario did to the fleet.
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
};

// The name of a kind, the unit of `value`, and what an incident of the kind means, for pages and the archive's views.
struct IncidentKindInfo {
  IncidentKind kind;
  std::string_view name, unit, meaning;
};
std::span<const IncidentKindInfo> incident_kinds();  // in order of their numbers, without gaps
const IncidentKindInfo& info_of(IncidentKind kind);
bool is_incident_kind(std::uint32_t number);
constexpr bool accuses(IncidentKind kind) { return kind < IncidentKind::FaultInjected; }

// Something that a law found. `a` and `b` are the bodies concerned, each invalid if there is none.
struct Incident {
  IncidentKind kind = IncidentKind::BatteryEmpty;
  EntityId a, b;
  SimTime first{}, last{};
  std::int64_t value = 0;  // in the unit of the kind

  friend bool operator==(const Incident&, const Incident&) = default;
};

// Of an incident FaultInjected: the kind of the fault, in the words of a scenario.
std::string_view fault_word(const Incident& incident);
bool is_load_drop(const Incident& incident);

}  // namespace fleetproof
