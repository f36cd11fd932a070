#include "core/outcome/run_result.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/outcome/foreign_bodies.hpp"

namespace fleetproof {
namespace {

bool ended_early(const Outcome& outcome) {
  return outcome.crash || outcome.hang || outcome.indeterminate || outcome.engine_error;
}

RunResult result(bool failed, bool undecided) {
  if (failed) return RunResult::Failed;
  return undecided ? RunResult::Unknown : RunResult::Passed;
}

// At least of this level. Without a list of violations, the flags of the outcome say it.
RunResult violations(const Outcome& outcome, ViolationLevel level) {
  if (outcome.violations.empty()) {
    const bool happened = level == ViolationLevel::SafetyDistance ? outcome.violation || outcome.contact
                                                                  : level == ViolationLevel::Contact && outcome.contact;
    return result(happened, ended_early(outcome));
  }
  bool failed = false, undecided = ended_early(outcome);
  const std::vector<bool> answers = answerable(outcome);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (level_of(outcome.violations[i]) < level) continue;
    (answers[i] ? failed : undecided) = true;
  }
  return result(failed, undecided);
}

bool fails(const Incident& incident, EndPoint end_point) { return info_of(incident.kind).end_point == end_point; }

// The beginning of the first pair that ended in a contact; kForever without one.
SimTime first_wreck(const Outcome& outcome) {
  SimTime first = kForever;
  for (const Violation& violation : outcome.violations) {
    if (violation.contact) first = std::min(first, violation.first);
  }
  return first;
}

RunResult incidents(const Outcome& outcome, EndPoint end_point) {
  const bool is_lack = info_of(end_point).is_lack_of_progress;
  bool failed = false, undecided = ended_early(outcome) || (is_lack && first_wreck(outcome) != kForever);
  for (const Incident& incident : outcome.incidents) {
    if (fails(incident, end_point)) (fails_by(outcome, incident) ? failed : undecided) = true;
  }
  return result(failed, undecided);
}

}  // namespace

bool fails_by(const Outcome& outcome, const Incident& incident) {
  if (!info_of(info_of(incident.kind).end_point.value()).is_lack_of_progress) return true;
  return !ended_early(outcome) && surely_began(incident) < first_wreck(outcome) && !foreign_body_lay(outcome, incident);
}

RunResult result_of(const Outcome& outcome, EndPoint end_point) {
  switch (end_point) {
    case EndPoint::Violation:
      return violations(outcome, ViolationLevel::SafetyDistance);
    case EndPoint::Contact:
      return violations(outcome, ViolationLevel::Contact);
    case EndPoint::HazardousContact:
      return violations(outcome, ViolationLevel::HazardousContact);
    case EndPoint::Deadlock:
    case EndPoint::Livelock:
    case EndPoint::Starvation:
    case EndPoint::Standstill:
    case EndPoint::WrongLoad:
    case EndPoint::EmptyBattery:
      return incidents(outcome, end_point);
    case EndPoint::Crash:
      return result(outcome.crash, ended_early(outcome));
    case EndPoint::Hang:
      return result(outcome.hang, ended_early(outcome));
    case EndPoint::Throughput:
      break;
  }
  invariant_violated("the throughput of a unit is judged over its runs");
}

JudgedOutcome judged(const Outcome& outcome) {
  JudgedOutcome sets;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if (end_point == EndPoint::Throughput) continue;
    const RunResult result = result_of(outcome, end_point);
    if (result == RunResult::Failed) sets.failed |= bit_of(end_point);
    if (result == RunResult::Unknown) sets.unknown |= bit_of(end_point);
  }
  return sets;
}

RunResult result_of(const JudgedOutcome& judged, EndPoint end_point) {
  return result((judged.failed & bit_of(end_point)) != 0, (judged.unknown & bit_of(end_point)) != 0);
}

const char* judged_word(const JudgedOutcome& judged) {
  if (judged.failed != 0) return "failed";
  return judged.unknown != 0 ? "unknown" : "passed";
}

bool has_measured_clearance(const Outcome& outcome) {
  return outcome.min_clearance_um || (!outcome.engine_error && outcome.simulated_ns > 0);
}

}  // namespace fleetproof
