#include "reports/evidence/first_cause.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/outcome/foreign_bodies.hpp"
#include "core/outcome/run_failures.hpp"

namespace fleetproof {
namespace {

bool is_fault(const Incident& incident) { return is_condition(incident.kind); }

// Its AGVs depend on it, whichever they are.
bool is_of_computer(const Incident& fault, std::uint32_t agv_count) {
  return fault.kind == IncidentKind::FaultInjected && fault.a.value >= agv_count;
}

// Of a fault that touched a body involved. Whether an AGV notices that its load is gone depends on the vehicle.
CameBefore before_of(const Incident& fault) {
  if (fault.kind == IncidentKind::ForeignBody) return CameBefore::ForeignBody;
  return is_load_drop(fault) ? CameBefore::Undecided : CameBefore::KnownFault;
}

}  // namespace

std::optional<FirstCause> first_cause(const Outcome& outcome) {
  const auto leading = chosen_failure(outcome, {});
  if (!leading) return std::nullopt;
  std::optional cause(FirstCause{leading->what, leading->at, leading->a, leading->b, {}, {}});
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
    const bool touches = fault.a == cause->a || fault.a == cause->b || is_of_computer(fault, outcome.agv_count);
    if (!names_bodies || !touches) continue;
    if (has_foreign && fault.kind != IncidentKind::ForeignBody) continue;  // the body says more than its AGV's faults
    note(before_of(fault), fault);
  }
  if (has_foreign) cause->before = CameBefore::ForeignBody;
  // A pair of AGVs that no fault touched is a finding; of a fleet that stands still nobody knows what it waits for.
  const bool pair = leading->is_violation && cause->a.valid() && cause->b.valid();
  if (cause->before == CameBefore::Nothing && any_before && !pair) cause->before = CameBefore::Undecided;
  return cause;
}

bool is_judged(IncidentKind kind) { return info_of(kind).end_point.has_value(); }

std::string fault_text(const FirstCause& cause, std::string_view struck) {
  const Incident& fault = cause.fault.value();
  std::string what = is_fallen_load(fault) ? "a load fell" : "an obstacle appeared";
  if (fault.kind == IncidentKind::FaultInjected) what = fmt::format("the {} of {} began", fault_word(fault), struck);
  const std::int64_t hundredths = (to_ns(cause.at) - to_ns(fault.first)) / 10'000'000;
  return fmt::format("{}.{:02} s after {}", hundredths / 100, hundredths % 100, what);
}

}  // namespace fleetproof
