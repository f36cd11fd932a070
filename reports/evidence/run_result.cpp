#include "reports/evidence/run_result.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/first_cause.hpp"
#include "reports/evidence/foreign_bodies.hpp"

namespace fleetproof {
namespace {

// What a run says about an end point: between which instants its first event lies, and whether something else leaves
// the end point undecided.
class Findings {
 public:
  explicit Findings(bool undecided) : undecided_(undecided) {}

  void event(SimTime earliest, SimTime latest) {
    failed_ = true;
    earliest_ = std::min(earliest_, earliest);
    latest_ = std::min(latest_, latest);
  }
  void leave_undecided() { undecided_ = true; }

  RunResult result() const {
    if (failed_) return RunResult::Failed;
    return undecided_ ? RunResult::Unknown : RunResult::Passed;
  }
  SimTime earliest() const { return earliest_; }
  SimTime latest() const { return latest_; }

 private:
  bool failed_ = false, undecided_;
  SimTime earliest_ = kForever, latest_ = kForever;
};

bool ended_early(const Outcome& outcome) {
  return outcome.crash || outcome.hang || outcome.indeterminate || outcome.engine_error;
}

// Of events of which an outcome tells no instant.
Findings some_time(const Outcome& outcome, bool happened) {
  Findings findings(ended_early(outcome));
  if (happened) findings.event(kStart, kForever);
  return findings;
}

// At least of this level. Without a list of violations, the flags of the outcome say it.
Findings violations(const Outcome& outcome, ViolationLevel level) {
  if (outcome.violations.empty()) {
    return some_time(outcome, level == ViolationLevel::SafetyDistance
                                  ? outcome.violation || outcome.contact
                                  : level == ViolationLevel::Contact && outcome.contact);
  }
  Findings findings(ended_early(outcome));
  const std::vector<bool> answers = answerable(outcome);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Violation& violation = outcome.violations[i];
    if (level_of(violation) < level) continue;
    if (!answers[i]) {
      findings.leave_undecided();
      continue;
    }
    findings.event(violation.first, level == ViolationLevel::SafetyDistance ? violation.first : violation.last);
  }
  return findings;
}

bool fails(const Incident& incident, EndPoint end_point) { return info_of(incident.kind).end_point == end_point; }

Findings incidents(const Outcome& outcome, EndPoint end_point) {
  Findings findings(ended_early(outcome));
  for (const Incident& incident : outcome.incidents) {
    if (fails(incident, end_point)) findings.event(incident.first, incident.first);
  }
  return findings;
}

// The beginning of the first pair that ended in a contact; kForever without one.
SimTime first_wreck(const Outcome& outcome) {
  SimTime first = kForever;
  for (const Violation& violation : outcome.violations) {
    if (violation.contact) first = std::min(first, violation.first);
  }
  return first;
}

Findings lack_of_progress(const Outcome& outcome, EndPoint end_point) {
  const SimTime wreck = first_wreck(outcome);
  Findings findings(ended_early(outcome) || wreck != kForever);
  for (const Incident& incident : outcome.incidents) {
    if (!fails(incident, end_point)) continue;
    const SimTime began = surely_began(incident);
    if (ended_early(outcome) || began >= wreck || foreign_body_lay(outcome, incident)) {
      findings.leave_undecided();
    } else {
      findings.event(incident.first, began);
    }
  }
  return findings;
}

Findings findings_of(const Outcome& outcome, EndPoint end_point) {
  if (info_of(end_point).is_lack_of_progress) return lack_of_progress(outcome, end_point);
  switch (end_point) {
    case EndPoint::Violation:
      return violations(outcome, ViolationLevel::SafetyDistance);
    case EndPoint::Contact:
      return violations(outcome, ViolationLevel::Contact);
    case EndPoint::HazardousContact:
      return violations(outcome, ViolationLevel::HazardousContact);
    case EndPoint::WrongLoad:
    case EndPoint::EmptyBattery:
      return incidents(outcome, end_point);
    case EndPoint::Crash:
      return some_time(outcome, outcome.crash);
    case EndPoint::Hang:
      return some_time(outcome, outcome.hang);
    case EndPoint::Deadlock:
    case EndPoint::Livelock:
    case EndPoint::Starvation:
    case EndPoint::Standstill:
    case EndPoint::Throughput:
      break;
  }
  invariant_violated("the throughput of a unit is judged over its runs");
}

}  // namespace

RunResult result_of(const Outcome& outcome, EndPoint end_point) { return findings_of(outcome, end_point).result(); }

TimeAtRisk time_at_risk(const Outcome& outcome, EndPoint end_point, RunResult result) {
  const std::uint64_t whole_us = agv_us(outcome.simulated_ns, outcome.agv_count);
  if (result == RunResult::Passed) return {whole_us, whole_us};
  if (result == RunResult::Unknown) return {0, whole_us};
  const auto until = [&](SimTime instant) {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(to_ns(instant), 0));
    return agv_us(std::min(ns, outcome.simulated_ns), outcome.agv_count);
  };
  const Findings findings = findings_of(outcome, end_point);
  return {until(findings.earliest()), until(findings.latest())};
}

bool has_measured_clearance(const Outcome& outcome) {
  return outcome.min_clearance_um || (!outcome.engine_error && outcome.simulated_ns > 0);
}

}  // namespace fleetproof
