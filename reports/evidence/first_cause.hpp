#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/words.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// What the scenario had done to the bodies of a failure before it happened. It says what came before, not what caused
// it. Of several, the heaviest is told.
enum class CameBefore : std::uint8_t {
  Nothing,      // no injected fault touched a body involved or a computer
  KnownFault,   // a fault of an AGV involved, or of a computer: its software stopped or was away, or was told
  ForeignBody,  // a fallen load or an obstacle, which no control software is told of
  Undecided,    // faults or foreign bodies came before, but whether they touched the bodies involved is not known
};
constexpr const char* name_of(CameBefore before) {
  switch (before) {
    case CameBefore::Nothing:
      return "no injected fault";
    case CameBefore::KnownFault:
      return "a fault that the software could know of";
    case CameBefore::ForeignBody:
      return "a fallen load or an obstacle, of which no software is told";
    case CameBefore::Undecided:
      return "faults; which of them matter is not known";
  }
  return kNoWord;
}

constexpr std::uint32_t weight_of(CameBefore before) {
  switch (before) {
    case CameBefore::Nothing:
      return 0;
    case CameBefore::KnownFault:
      return 10;
    case CameBefore::ForeignBody:
      return 20;
    case CameBefore::Undecided:
      return 30;
  }
  return 0;
}

// The failure that leads a run (run_failures.hpp), and what came before it.
struct FirstCause {
  std::string what;  // "contact, two AGVs"
  SimTime at{};      // of a crash, a hang or a standstill: the end of the run
  EntityId a, b;     // each invalid if not known
  CameBefore before = CameBefore::Nothing;
  std::optional<Incident> fault;  // the last injected fault or foreign body that `before` speaks of
};

// Absent if nothing went wrong. Requires: the law "faults" watched the run; otherwise `before` is Nothing, or Undecided
// if the run counted faults.
std::optional<FirstCause> first_cause(const Outcome& outcome);

// Whether an end point of this archive may be judged on the incident (a deadlock, a wrong load, ...).
bool is_judged(IncidentKind kind);

// "1.20 s after the restart of AGV 3 began". `struck`: the name of what the fault struck. Requires: there is a fault.
std::string fault_text(const FirstCause& cause, std::string_view struck);

}  // namespace fleetproof
