#include "core/outcome/run_failures.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/run_result.hpp"

namespace fleetproof {
namespace {

std::string pair_text(EntityId a, EntityId b, const Outcome& outcome) {
  if (!a.valid() && !b.valid()) return "";
  if (!a.valid() || !b.valid()) return ", one body";
  return is_foreign(a, outcome) || is_foreign(b, outcome) ? ", AGV and another body" : ", two AGVs";
}

SimTime end_of(const Outcome& outcome) { return at_ns(static_cast<std::int64_t>(outcome.simulated_ns)); }

EndPoint end_point_of(ViolationLevel level) {
  switch (level) {
    case ViolationLevel::SafetyDistance:
      return EndPoint::Violation;
    case ViolationLevel::Contact:
      return EndPoint::Contact;
    case ViolationLevel::HazardousContact:
      break;
  }
  return EndPoint::HazardousContact;
}

RunFailure failure_of(const Violation& violation, bool is_judged, const Outcome& outcome) {
  RunFailure failure{.end_point = end_point_of(level_of(violation)),
                     .what = name_of(level_of(violation)) + pair_text(violation.a, violation.b, outcome),
                     .at = violation.first,
                     .seen = violation.closest_at,
                     .a = violation.a,
                     .b = violation.b,
                     .is_violation = true,
                     .is_judged = is_judged};
  failure.is_over = violation.last < end_of(outcome);
  return failure;
}

RunFailure failure_of(const Incident& incident, const Outcome& outcome) {
  const IncidentKindInfo& info = info_of(incident.kind);
  RunFailure failure{.end_point = info.end_point,
                     .what = std::string(info.name) + pair_text(incident.a, incident.b, outcome),
                     .at = incident.first,
                     .seen = incident.last,
                     .a = incident.a,
                     .b = incident.b};
  failure.is_judged = fails_by(outcome, incident);
  failure.is_over = incident.last < end_of(outcome);
  return failure;
}

// Of a flag of the outcome that nothing else tells.
struct FlaggedEnd {
  OutcomeClass id;
  std::optional<EndPoint> end_point;
};
constexpr auto kFlaggedEnds = std::to_array<FlaggedEnd>({{OutcomeClass::Contact, EndPoint::Contact},
                                                         {OutcomeClass::Violation, EndPoint::Violation},
                                                         {OutcomeClass::Crash, EndPoint::Crash},
                                                         {OutcomeClass::Hang, EndPoint::Hang},
                                                         {OutcomeClass::EngineError, std::nullopt},
                                                         {OutcomeClass::Indeterminate, std::nullopt},
                                                         {OutcomeClass::Stuck, std::nullopt}});
static_assert(kFlaggedEnds.size() == kRunEnds.size(), "each flag has a line");

// The violations of an outcome without a list of them, and what is no violation and no incident. A fleet that is stuck
// has an incident that says why, if a law knows it.
void add_flagged(std::vector<RunFailure>& all, const Outcome& outcome) {
  const bool has_incident = std::ranges::any_of(all, [](const RunFailure& f) { return !f.is_violation; });
  for (const auto& [id, end_point] : kFlaggedEnds) {
    const bool is_listed = (id == OutcomeClass::Contact || id == OutcomeClass::Violation) &&
                           (!outcome.violations.empty() || (id == OutcomeClass::Violation && outcome.contact));
    if (!(outcome.*find_run_end(id)->flag) || is_listed || (id == OutcomeClass::Stuck && has_incident)) continue;
    RunFailure failure{.end_point = end_point, .what = name_of(id), .at = end_of(outcome), .seen = end_of(outcome)};
    failure.is_judged = end_point.has_value();
    all.push_back(std::move(failure));
  }
}

}  // namespace

std::uint32_t RunFailure::weight() const {
  if (!end_point) return 0;
  const EndPointInfo& info = info_of(*end_point);
  return is_over ? info.weight_if_over : info.weight;
}

std::vector<RunFailure> failures_of(const Outcome& outcome) {
  std::vector<RunFailure> all;
  const std::vector<bool> answers = answerable(outcome);
  for (std::size_t i = 0; i < outcome.violations.size(); ++i)
    all.push_back(failure_of(outcome.violations[i], answers[i], outcome));
  for (const Incident& incident : outcome.incidents) {
    if (info_of(incident.kind).end_point) all.push_back(failure_of(incident, outcome));
  }
  add_flagged(all, outcome);
  std::ranges::stable_sort(all, {}, [](const RunFailure& failure) {
    return std::tuple(!failure.is_judged, -std::int64_t{failure.weight()}, failure.at);
  });
  return all;
}

std::optional<RunFailure> chosen_failure(const Outcome& outcome, FailureChoice choice) {
  for (RunFailure& failure : failures_of(outcome)) {
    const bool is_meant =
        choice.end_points == 0 || (failure.end_point && (choice.end_points & bit_of(*failure.end_point)) != 0);
    if (is_meant) return std::move(failure);
  }
  return std::nullopt;
}

std::string end_of_run(const Outcome& outcome) {
  const OutcomeClass end = outcome.outcome_class();
  const auto leading = end == OutcomeClass::Clean ? chosen_failure(outcome, {}) : std::nullopt;
  if (!leading) return name_of(end);
  std::string word = leading->end_point ? name_of(*leading->end_point) : leading->what;
  if (!leading->is_judged) word += ", not judged";
  return word;
}

bool is_same_failure(const RunFailure& a, const RunFailure& b) { return a.what == b.what && a.a == b.a && a.b == b.b; }

}  // namespace fleetproof
