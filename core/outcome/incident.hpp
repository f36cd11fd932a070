#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

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
};

// How a kind is called, what `value` counts, and what it says, for pages and the archive's views.
struct IncidentKindInfo {
  IncidentKind kind;
  std::string_view name, unit, meaning;
};
std::span<const IncidentKindInfo> incident_kinds();  // in order of their numbers, without gaps
const IncidentKindInfo& info_of(IncidentKind kind);
bool is_incident_kind(std::uint32_t number);

// Something that a law found. `a` and `b` are whom it concerns, each invalid if there is none.
struct Incident {
  IncidentKind kind = IncidentKind::BatteryEmpty;
  EntityId a, b;
  SimTime first{}, last{};
  std::int64_t value = 0;  // in the unit of the kind

  friend bool operator==(const Incident&, const Incident&) = default;
};

// Who says that something was met: the world (an observer of the run), or the agent by its host's `sometimes`.
enum class ProbeSource : std::uint8_t { World = 0, Agent = 1 };
const char* name_of(ProbeSource source);

// How often something was met in a run.
struct ProbeCount {
  ProbeSource source = ProbeSource::World;
  std::string name;
  std::uint64_t count = 0;

  friend bool operator==(const ProbeCount&, const ProbeCount&) = default;
};

// What the agents of a run declare, summed by name. Bounded, so that an agent that makes up names costs its run nothing
// but a number.
class ProbeTally {
 public:
  static constexpr std::size_t kNamesMax = 64;  // different names in a run
  static constexpr std::size_t kNameBytesMax = 64;

  // `hash` identifies the name.
  void declare(std::string_view name, std::uint64_t hash);
  std::vector<ProbeCount> counts() const;               // by name
  std::uint64_t left_out() const { return left_out_; }  // declarations beyond the bounds

 private:
  struct Seen {
    std::uint64_t hash = 0, count = 0;
    std::string name;
  };
  std::vector<Seen> seen_;
  std::uint64_t left_out_ = 0;
};

}  // namespace fleetproof
