#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"
#include "core/outcome/counters.hpp"
#include "core/outcome/incident.hpp"
#include "core/outcome/probes.hpp"

namespace fleetproof {

// The class of a run: of what happened in it, what outranks the rest (kRunEnds).
enum class OutcomeClass : std::uint8_t { EngineError, Contact, Violation, Crash, Hang, Indeterminate, Stuck, Clean };
constexpr const char* name_of(OutcomeClass c) {
  switch (c) {
    case OutcomeClass::EngineError:
      return "engine_error";
    case OutcomeClass::Contact:
      return "contact";
    case OutcomeClass::Violation:
      return "violation";
    case OutcomeClass::Crash:
      return "crash";
    case OutcomeClass::Hang:
      return "hang";
    case OutcomeClass::Indeterminate:
      return "indeterminate";
    case OutcomeClass::Stuck:
      return "stuck";
    case OutcomeClass::Clean:
      return "clean";
  }
  return kNoWord;
}

// An unbroken time in which two bodies were closer than the minimal safety distance. `a` < `b`.
struct Violation {
  EntityId a, b;
  SimTime first{}, last{};
  SimTime closest_at{};
  std::int64_t min_clearance_um = 0;     // rounded down; 0 in a contact: the depth of an overlap is not measured
  std::int64_t relative_speed_um_s = 0;  // of the closest points, as they move with their bodies; at `closest_at`, but
                                         // in a contact or a flat minimum the highest while it lasts
  std::int64_t normal_speed_um_s = 0;    // the part of it along the line between these points, or along the contact
                                         // normal; above zero if they come nearer
  std::int64_t x_um = 0, y_um = 0;       // midway between the centres of the bodies at `closest_at`
  bool contact = false;

  friend bool operator==(const Violation&, const Violation&) = default;
};

// The three levels of a violation. Hazardous: somewhere in the contact, the two were faster than kHazardousSpeed_um_s.
enum class ViolationLevel : std::uint8_t { SafetyDistance, Contact, HazardousContact };
inline constexpr std::int64_t kHazardousSpeed_um_s = 300'000;
ViolationLevel level_of(const Violation& violation);
const char* name_of(ViolationLevel level);

// The result of one run: flat, whole numbers only.
struct Outcome {
  bool violation = false, contact = false, stuck = false, crash = false, hang = false, indeterminate = false,
       engine_error = false;
  std::optional<std::int64_t> min_clearance_um;  // absent: always more than 0.5 m, or not measured
  std::vector<Violation> violations;             // in order of (first, a, b)
  std::vector<Incident> incidents;               // of all laws that ran, in order of (first, kind, a, b)
  std::vector<ProbeCount> probes;                // what the run met, in order of (source, name); never a count of zero
  Counters counters;
  std::uint64_t simulated_ns = 0;
  std::uint32_t agv_count = 0;
  std::uint64_t digest = 0;                    // of the whole trace
  std::vector<std::uint64_t> running_digests;  // after events 1, 2, 4, 8, ...
  std::string message;                         // of a crash, hang or engine error

  OutcomeClass outcome_class() const;
  // Worth a replay.
  bool is_failure() const;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

// All that is known of a flag of an outcome. Weight: of several, the class of the run is the one with the highest, so
// that a crash hides no violation before it. Seriousness: a failing run stands in a list where its highest one says.
// Both are as serious as the flag itself, but for an error of the simulator: the class tells it before all else, since
// then nothing else is sure; a list tells what the software did first.
struct RunEnd {
  OutcomeClass id;
  bool Outcome::*flag;
  std::uint32_t weight, seriousness;
  bool is_failure;  // the run broke something, or its software did: worth a replay
  std::string_view meaning;
};
// The encoding and the archive hold the flags in this order. Append only, together with a new version.
inline constexpr auto kRunEnds = std::to_array<RunEnd>({
    {OutcomeClass::Violation, &Outcome::violation, 50, 60, true, "AGVs were closer than the safety distance"},
    {OutcomeClass::Contact, &Outcome::contact, 60, 70, true, "bodies touched"},
    {OutcomeClass::Stuck, &Outcome::stuck, 10, 10, false, "transports were open and nothing began or ended"},
    {OutcomeClass::Crash, &Outcome::crash, 40, 50, true, "control software crashed"},
    {OutcomeClass::Hang, &Outcome::hang, 30, 40, true, "control software hung"},
    {OutcomeClass::Indeterminate, &Outcome::indeterminate, 20, 30, false, "the run could not be judged"},
    {OutcomeClass::EngineError, &Outcome::engine_error, 70, 20, true, "the simulator met an error of its own"},
});
// A clean run has no flag, and no line.
static_assert(kRunEnds.size() == kValuesOf<OutcomeClass>.size() - 1, "each flag has a line");
const RunEnd* find_run_end(OutcomeClass id);

// The one canonical byte encoding (little-endian, version first): what a pipe carries and what a row's checksum covers.
// An earlier version has fewer fields; the checksums of older archives are over it.
inline constexpr std::uint32_t kEncodingVersion = 6;
inline constexpr std::uint32_t kEncodingWithoutWithdrawn = 5;
inline constexpr std::uint32_t kEncodingWithoutProcessorChanges = 4;
inline constexpr std::uint32_t kEncodingWithoutNormalSpeed = 3;
std::string encode(const Outcome& outcome, std::uint32_t version = kEncodingVersion);
// Throws EngineError on bytes that `encode` did not write in its newest version.
Outcome decode_outcome(std::string_view bytes);

// Sets violation, contact and smallest clearance from the violations a law filed.
void file_violations(Outcome& outcome, std::vector<Violation> violations);

// A run keeps at most this many incidents. The earliest of each kind stays in any case, then the earliest accusations.
// The room that is left is for the earliest incidents that accuse nobody. All others are counted.
inline constexpr std::size_t kIncidentsMax = 1000;
void file_incidents(Outcome& outcome, std::vector<Incident> incidents);
void file_probes(Outcome& outcome, std::vector<ProbeCount> probes);

}  // namespace fleetproof
