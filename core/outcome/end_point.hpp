#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/words.hpp"

namespace fleetproof {

// What a run may fail, and what a gate of a campaign counts. Incidents name the end point that they fail
// (incident.hpp); violations and the flags of an outcome decide the others. Results files store the numbers: a new one
// stands at the end.
enum class EndPoint : std::uint8_t {
  Violation,
  Contact,
  HazardousContact,
  Deadlock,
  Livelock,
  Starvation,
  Standstill,
  WrongLoad,
  EmptyBattery,
  Crash,
  Hang,
  Throughput
};
constexpr const char* name_of(EndPoint end_point) {
  switch (end_point) {
    case EndPoint::Violation:
      return "violation";
    case EndPoint::Contact:
      return "contact";
    case EndPoint::HazardousContact:
      return "hazardous-contact";
    case EndPoint::Deadlock:
      return "deadlock";
    case EndPoint::Livelock:
      return "livelock";
    case EndPoint::Starvation:
      return "starvation";
    case EndPoint::Standstill:
      return "standstill";
    case EndPoint::WrongLoad:
      return "wrong-load";
    case EndPoint::EmptyBattery:
      return "empty-battery";
    case EndPoint::Crash:
      return "crash";
    case EndPoint::Hang:
      return "hang";
    case EndPoint::Throughput:
      return "throughput";
  }
  return kNoWord;
}

// Lack: in a run that fails it, AGVs had work and did not get it done.
// Stall weight: which lack of progress a page tells first if a run has several. Above 0: the fleet stalled, although
// nothing says that its radio or its AGVs were out of order.
// Weight: of several failures of a run, the one with the highest leads (run_failures.hpp). Weight if over: of one that
// had passed before the run ended; what cannot be undone keeps its weight.
struct EndPointInfo {
  EndPoint id;
  bool is_lack_of_progress;
  std::uint32_t stall_weight, weight, weight_if_over;
};
inline constexpr auto kEndPoints = std::to_array<EndPointInfo>({
    {EndPoint::Violation, false, 0, 60, 60},
    {EndPoint::Contact, false, 0, 70, 70},
    {EndPoint::HazardousContact, false, 0, 80, 80},
    {EndPoint::Deadlock, true, 3, 20, 10},
    {EndPoint::Livelock, true, 2, 20, 10},
    {EndPoint::Starvation, true, 1, 20, 10},
    {EndPoint::Standstill, true, 0, 20, 10},
    {EndPoint::WrongLoad, false, 0, 50, 50},
    {EndPoint::EmptyBattery, false, 0, 20, 10},
    {EndPoint::Crash, false, 0, 40, 40},
    {EndPoint::Hang, false, 0, 30, 30},
    {EndPoint::Throughput, false, 0, 0, 0},
});
static_assert(
    [] {
      for (std::size_t i = 0; i < kEndPoints.size(); ++i) {
        if (kEndPoints[i].id != kValuesOf<EndPoint>[i]) return false;
      }
      return kEndPoints.size() == kValuesOf<EndPoint>.size();
    }(),
    "each end point has one line, at its own number");

constexpr const EndPointInfo& info_of(EndPoint end_point) { return kEndPoints.at(static_cast<std::size_t>(end_point)); }
constexpr bool is_stall(EndPoint end_point) { return info_of(end_point).stall_weight > 0; }

// The end points that a run failed, and those of which nothing is known, as sets of bits (bit_of). Throughput, which
// takes more than one run, is in neither.
struct JudgedOutcome {
  std::uint32_t failed = 0, unknown = 0;
  friend bool operator==(const JudgedOutcome&, const JudgedOutcome&) = default;
};
constexpr std::uint32_t bit_of(EndPoint end_point) { return 1U << static_cast<unsigned>(end_point); }

}  // namespace fleetproof
