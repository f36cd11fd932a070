#include "reports/evidence/failing_run.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

std::optional<Incident> first_judged(const Outcome& outcome) {
  const auto found =
      std::ranges::find_if(outcome.incidents, [](const Incident& incident) { return is_judged(incident.kind); });
  if (found == outcome.incidents.end()) return std::nullopt;
  return *found;
}

std::optional<Severity> severity_of(const Outcome& o) {
  if (o.contact) return Severity::Contact;
  if (o.violation) return Severity::Violation;
  if (o.crash) return Severity::Crash;
  if (o.hang) return Severity::Hang;
  if (o.indeterminate) return Severity::Indeterminate;
  if (o.engine_error) return Severity::EngineError;
  if (o.stuck) return Severity::Stuck;
  if (first_judged(o)) return Severity::Incident;
  return std::nullopt;
}

// The least is the worst: by level, then by the speed of a contact, else by the clearance.
std::tuple<int, std::int64_t, std::int64_t> worst_first(const Violation& v) {
  return {-static_cast<int>(level_of(v)), v.contact ? -v.relative_speed_um_s : 0, v.min_clearance_um};
}

}  // namespace

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::Contact:
      return "contact";
    case Severity::Violation:
      return "violation";
    case Severity::Crash:
      return "crash";
    case Severity::Hang:
      return "hang";
    case Severity::Indeterminate:
      return "indeterminate";
    case Severity::EngineError:
      return "engine error";
    case Severity::Stuck:
      return "stuck";
    case Severity::Incident:
      return "incident";
  }
  invariant_violated("a severity has a name");
}

std::optional<FailingRun> FailingRun::of(const RunRecord& run) {
  const auto severity = severity_of(run.outcome);
  if (!severity) return std::nullopt;
  FailingRun failing;
  failing.run_index = run.run_index;
  failing.replicate = run.replicate;
  failing.cell = run.cell;
  failing.factors = run.factors;
  failing.severity = *severity;
  failing.min_clearance_um = run.outcome.min_clearance_um;
  failing.violations = run.outcome.violations.size();
  failing.message = run.outcome.message;
  const auto cause = first_cause(run.outcome);
  ensure(cause.has_value(), "what failed has a first cause");
  failing.cause = *cause;
  failing.incident = first_judged(run.outcome);
  if (const Violation* worst = worst_of(run.outcome.violations)) failing.worst = *worst;
  return failing;
}

const Violation* worst_of(const std::vector<Violation>& violations) {
  const auto worst = std::ranges::min_element(violations, {}, worst_first);
  return worst == violations.end() ? nullptr : &*worst;
}

bool more_serious(const FailingRun& a, const FailingRun& b) {
  const auto rank = [](const FailingRun& run) {
    return std::tuple(run.severity, worst_first(run.worst.value_or(Violation{})),
                      run.min_clearance_um.value_or(std::numeric_limits<std::int64_t>::max()), run.run_index);
  };
  return rank(a) < rank(b);
}

void WorstRuns::add(const FailingRun& run) {
  list_.insert(std::ranges::upper_bound(list_, run, more_serious), run);
  if (list_.size() > capacity_) list_.pop_back();
}

}  // namespace fleetproof
