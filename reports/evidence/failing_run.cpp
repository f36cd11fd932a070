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

std::optional<OutcomeClass> most_serious(const Outcome& outcome) {
  const RunEnd* first = nullptr;
  for (const RunEnd& end : kRunEnds) {
    if (outcome.*end.flag && (first == nullptr || end.seriousness > first->seriousness)) first = &end;
  }
  if (first != nullptr) return first->id;
  return first_judged(outcome) ? std::optional(OutcomeClass::Clean) : std::nullopt;
}

std::optional<Incident> leading_incident(const Outcome& outcome, const FirstCause& cause) {
  const auto leads = [&](const Incident& incident) {
    return is_judged(incident.kind) && incident.first == cause.at && incident.a == cause.a && incident.b == cause.b &&
           cause.what.starts_with(info_of(incident.kind).name);
  };
  const auto found = std::ranges::find_if(outcome.incidents, leads);
  return found == outcome.incidents.end() ? first_judged(outcome) : *found;
}

// The least is the worst: by level, then by the speed of a contact, else by the clearance.
std::tuple<int, std::int64_t, std::int64_t> worst_first(const Violation& v) {
  return {-static_cast<int>(level_of(v)), v.contact ? -v.relative_speed_um_s : 0, v.min_clearance_um};
}

}  // namespace

std::optional<FailingRun> FailingRun::of(const RunRecord& run) {
  const auto end = most_serious(run.outcome);
  if (!end) return std::nullopt;
  FailingRun failing;
  failing.run_index = run.run_index;
  failing.replicate = run.replicate;
  failing.cell = run.cell;
  failing.factors = run.factors;
  failing.end = *end;
  failing.min_clearance_um = run.outcome.min_clearance_um;
  failing.violations = run.outcome.violations.size();
  failing.message = run.outcome.message;
  failing.digest = run.outcome.digest;
  const auto cause = first_cause(run.outcome);
  ensure(cause.has_value(), "what failed has a first cause");
  failing.cause = *cause;
  failing.incident = leading_incident(run.outcome, *cause);
  if (const Violation* worst = worst_of(run.outcome.violations)) failing.worst = *worst;
  return failing;
}

std::uint32_t FailingRun::seriousness() const {
  const RunEnd* known = find_run_end(end);
  return known == nullptr ? 0 : known->seriousness;
}

const char* FailingRun::severity() const {
  if (end == OutcomeClass::Clean) return "incident";
  return end == OutcomeClass::EngineError ? "engine error" : name_of(end);
}

const Violation* worst_of(const std::vector<Violation>& violations) {
  const auto worst = std::ranges::min_element(violations, {}, worst_first);
  return worst == violations.end() ? nullptr : &*worst;
}

bool more_serious(const FailingRun& a, const FailingRun& b) {
  const auto rank = [](const FailingRun& run) {
    return std::tuple(-std::int64_t{run.seriousness()}, worst_first(run.worst.value_or(Violation{})),
                      run.min_clearance_um.value_or(std::numeric_limits<std::int64_t>::max()), run.run_index);
  };
  return rank(a) < rank(b);
}

void WorstRuns::add(const FailingRun& run) {
  if (list_.size() == capacity_ && (list_.empty() || !more_serious(run, list_.back()))) return;
  list_.insert(std::ranges::upper_bound(list_, run, more_serious), run);
  if (list_.size() > capacity_) list_.pop_back();
}

}  // namespace fleetproof
