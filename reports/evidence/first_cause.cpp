#include "reports/evidence/first_cause.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "core/outcome/foreign_bodies.hpp"

namespace fleetproof {
namespace {

std::string pair_text(EntityId a, EntityId b, const Outcome& outcome) {
  if (!a.valid() && !b.valid()) return "";
  if (!a.valid() || !b.valid()) return ", one body";
  return is_foreign(a, outcome) || is_foreign(b, outcome) ? ", AGV and another body" : ", two AGVs";
}

FirstCause cause_of(const Violation& violation, const Outcome& outcome) {
  return {name_of(level_of(violation)) + pair_text(violation.a, violation.b, outcome),
          violation.first,
          violation.a,
          violation.b,
          {},
          {}};
}

FirstCause cause_of(const Incident& incident, const Outcome& outcome) {
  return {std::string(info_of(incident.kind).name) + pair_text(incident.a, incident.b, outcome),
          incident.first,
          incident.a,
          incident.b,
          {},
          {}};
}

std::optional<FirstCause> bare_cause(const Outcome& outcome) {
  const auto incident = std::ranges::find_if(outcome.incidents, [](const Incident& i) { return is_judged(i.kind); });
  const bool has_incident = incident != outcome.incidents.end();
  if (!outcome.violations.empty() && (!has_incident || outcome.violations.front().first <= surely_began(*incident)))
    return cause_of(outcome.violations.front(), outcome);
  if (has_incident) return cause_of(*incident, outcome);
  const auto end = at_ns(static_cast<std::int64_t>(outcome.simulated_ns));
  if (outcome.outcome_class() == OutcomeClass::Clean) return std::nullopt;
  return FirstCause{name_of(outcome.outcome_class()), end, {}, {}, {}, {}};
}

bool is_fault(const Incident& incident) { return !accuses(incident.kind); }

// Of a fault that touched a body involved. Whether an AGV notices that its load is gone depends on the vehicle.
CameBefore before_of(const Incident& fault) {
  if (fault.kind == IncidentKind::ForeignBody) return CameBefore::ForeignBody;
  return is_load_drop(fault) ? CameBefore::Undecided : CameBefore::KnownFault;
}

}  // namespace

std::optional<FirstCause> first_cause(const Outcome& outcome) {
  auto cause = bare_cause(outcome);
  if (!cause) return cause;
  const bool names_bodies = cause->a.valid() && (cause->b.valid() || !is_foreign(cause->a, outcome));
  const bool has_foreign = is_foreign(cause->a, outcome) || is_foreign(cause->b, outcome);
  bool any_before = outcome.counters.faults > 0 && std::ranges::none_of(outcome.incidents, is_fault);
  const auto note = [&](CameBefore before, const Incident& fault) {
    cause->before = std::ranges::max(cause->before, before, {}, weight_of);
    if (!cause->fault || cause->fault->first <= fault.first) cause->fault = fault;
  };
  for (const Incident& fault : outcome.incidents) {
    if (!is_fault(fault) || fault.first > cause->at) continue;
    any_before = true;
    if (!names_bodies || (fault.a != cause->a && fault.a != cause->b)) continue;
    if (has_foreign && fault.kind != IncidentKind::ForeignBody) continue;  // the body says more than its AGV's faults
    note(before_of(fault), fault);
  }
  if (has_foreign) cause->before = CameBefore::ForeignBody;
  // A pair of AGVs that no fault touched is a finding; of a fleet that stands still nobody knows what it waits for.
  const bool pair = cause->a.valid() && cause->b.valid() && !outcome.violations.empty() &&
                    cause->at == outcome.violations.front().first;
  if (cause->before == CameBefore::Nothing && any_before && !pair) cause->before = CameBefore::Undecided;
  return cause;
}

bool is_judged(IncidentKind kind) { return info_of(kind).end_point.has_value(); }

std::string fault_text(const FirstCause& cause, std::uint32_t agv_count) {
  if (!cause.fault) return "";
  const Incident& fault = *cause.fault;
  std::string what = is_fallen_load(fault) ? "a load fell" : "an obstacle appeared";
  if (fault.kind == IncidentKind::FaultInjected) {
    what = fmt::format("the {} of AGV {} began", fault_word(fault), fault.a.value);
  } else {
    ensure(fault.a.value >= agv_count, "a foreign body is no AGV");
  }
  const std::int64_t hundredths = (to_ns(cause.at) - to_ns(fault.first)) / 10'000'000;
  return fmt::format("{}.{:02} s after {}", hundredths / 100, hundredths % 100, what);
}

}  // namespace fleetproof
