#include "reports/evidence/run_result.hpp"

#include <algorithm>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

bool ended_early(const Outcome& outcome) {
  return outcome.crash || outcome.hang || outcome.indeterminate || outcome.engine_error;
}

RunResult failed_or(bool failed, bool unknown) {
  if (failed) return RunResult::Failed;
  return unknown ? RunResult::Unknown : RunResult::Passed;
}

bool has_hazardous_contact(const Outcome& outcome) {
  return std::ranges::any_of(outcome.violations,
                             [](const Violation& v) { return level_of(v) == ViolationLevel::HazardousContact; });
}

bool is_wrong_load(const Incident& incident) {
  return incident.kind >= IncidentKind::LoadHeldByTwo && incident.kind <= IncidentKind::LoadMovedByNobody;
}

// The beginning of the first pair that ended in a contact; kForever without one.
SimTime first_wreck(const Outcome& outcome) {
  SimTime first = kForever;
  for (const Violation& violation : outcome.violations) {
    if (violation.contact) first = std::min(first, violation.first);
  }
  return first;
}

RunResult progress_result(const Outcome& outcome, IncidentKind kind) {
  const SimTime wreck = first_wreck(outcome);
  bool before_wreck = false, behind_wreck = false;
  for (const Incident& incident : outcome.incidents) {
    if (incident.kind == kind) (incident.first < wreck ? before_wreck : behind_wreck) = true;
  }
  const bool lost_an_agv = ended_early(outcome) || wreck != kForever;
  return failed_or(before_wreck && !ended_early(outcome), behind_wreck || lost_an_agv);
}

}  // namespace

RunResult result_of(const Outcome& outcome, EndPoint end_point) {
  const bool unknown = ended_early(outcome);
  const auto has = [&](IncidentKind kind) {
    return std::ranges::find(outcome.incidents, kind, &Incident::kind) != outcome.incidents.end();
  };
  switch (end_point) {
    case EndPoint::Violation:
      return failed_or(outcome.violation || outcome.contact, unknown);
    case EndPoint::Contact:
      return failed_or(outcome.contact, unknown);
    case EndPoint::HazardousContact:
      return failed_or(has_hazardous_contact(outcome), unknown);
    case EndPoint::Deadlock:
      return progress_result(outcome, IncidentKind::Deadlock);
    case EndPoint::Livelock:
      return progress_result(outcome, IncidentKind::Livelock);
    case EndPoint::Starvation:
      return progress_result(outcome, IncidentKind::Starvation);
    case EndPoint::Standstill:
      return progress_result(outcome, IncidentKind::StandstillInContract);
    case EndPoint::WrongLoad:
      return failed_or(std::ranges::any_of(outcome.incidents, is_wrong_load), unknown);
    case EndPoint::EmptyBattery:
      return failed_or(has(IncidentKind::BatteryEmpty), unknown);
    case EndPoint::Crash:
      return failed_or(outcome.crash, unknown);
    case EndPoint::Hang:
      return failed_or(outcome.hang, unknown);
    case EndPoint::Throughput:
      break;
  }
  invariant_violated("the throughput of a unit is judged over its runs");
}

}  // namespace fleetproof
