#include "reports/evidence/run_result.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "reports/evidence/first_cause.hpp"
#include "reports/evidence/foreign_bodies.hpp"

namespace fleetproof {
namespace {

bool ended_early(const Outcome& outcome) {
  return outcome.crash || outcome.hang || outcome.indeterminate || outcome.engine_error;
}

RunResult failed_or(bool failed, bool unknown) {
  if (failed) return RunResult::Failed;
  return unknown ? RunResult::Unknown : RunResult::Passed;
}

// At least of this level. Without a list of violations, the flags of the outcome say it.
RunResult violation_result(const Outcome& outcome, ViolationLevel level) {
  const bool unknown = ended_early(outcome);
  if (outcome.violations.empty()) {
    const bool violated = level == ViolationLevel::SafetyDistance ? outcome.violation || outcome.contact
                                                                  : level == ViolationLevel::Contact && outcome.contact;
    return failed_or(violated, unknown);
  }
  const std::vector<bool> answers = answerable(outcome);
  bool own = false, foreign = false;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (level_of(outcome.violations[i]) >= level) (answers[i] ? own : foreign) = true;
  }
  return failed_or(own, foreign || unknown);
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
  bool by_itself = false, consequence = false;
  for (const Incident& incident : outcome.incidents) {
    if (incident.kind != kind) continue;
    (surely_began(incident) < wreck && !foreign_body_lay(outcome, incident) ? by_itself : consequence) = true;
  }
  const bool lost_an_agv = ended_early(outcome) || wreck != kForever;
  return failed_or(by_itself && !ended_early(outcome), consequence || lost_an_agv);
}

}  // namespace

RunResult result_of(const Outcome& outcome, EndPoint end_point) {
  const bool unknown = ended_early(outcome);
  const auto has = [&](IncidentKind kind) {
    return std::ranges::find(outcome.incidents, kind, &Incident::kind) != outcome.incidents.end();
  };
  switch (end_point) {
    case EndPoint::Violation:
      return violation_result(outcome, ViolationLevel::SafetyDistance);
    case EndPoint::Contact:
      return violation_result(outcome, ViolationLevel::Contact);
    case EndPoint::HazardousContact:
      return violation_result(outcome, ViolationLevel::HazardousContact);
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
