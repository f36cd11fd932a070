#include "campaign/explain/last_stop.hpp"

#include <fmt/format.h>

#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/trials.hpp"
#include "core/base/shown_time.hpp"

namespace fleetproof {
namespace {

constexpr Duration kStopGrain = std::chrono::milliseconds(100), kLookBack = std::chrono::seconds(30);

Scenario stopped_at(const Scenario& scenario, EntityId agv, SimTime at) {
  Scenario stopped = scenario;
  Fault stop;
  stop.kind = Fault::Kind::ProtectiveStop;
  stop.agv = agv;
  stop.at = at - kStart;
  stop.lasts = scenario.horizon;
  stopped.faults.push_back(stop);
  return stopped;
}

Claim stop_claim(CaseHost& host, const FailingCase& failing, EntityId agv, SimTime at) {
  Scenario stopped = stopped_at(failing.scenario, agv, at);
  ExpectedOutcome outcome = expectation_of(host(stopped));
  return {fmt::format("{} brakes at {:.3f} s", name_of_body(failing.scenario, agv), shown_seconds(at)),
          std::move(stopped), std::move(outcome)};
}

LastStop last_stop_of(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern, EntityId agv) {
  LastStop found;
  found.agv = name_of_body(failing.scenario, agv);
  const Duration end = (failing.failure.at - kStart) / kStopGrain * kStopGrain;
  const auto count = static_cast<std::size_t>(std::min(end, kLookBack) / kStopGrain + 1);
  const auto at = [&](std::size_t i) { return kStart + end - kStopGrain * static_cast<std::int64_t>(i); };
  const auto runs =
      all_runs(host, {count, [&](std::size_t i) { return std::optional(stopped_at(failing.scenario, agv, at(i))); }});
  for (std::size_t i = 0; i < count && !found.at; ++i) {
    if (!avoids(*runs[i], failing, pattern)) continue;
    found.at = at(i);
    found.claims.push_back(stop_claim(host, failing, agv, at(i)));
    if (i > 0) found.claims.push_back(stop_claim(host, failing, agv, at(i - 1)));
  }
  if (!found.at) found.claims.push_back(stop_claim(host, failing, agv, at(count - 1)));
  return found;
}

}  // namespace

void add_last_stops(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                    std::vector<LastStop>& found) {
  for (const EntityId body : {failing.failure.a, failing.failure.b}) {
    if (body.valid() && body.index() < failing.scenario.agvs.size())
      found.push_back(last_stop_of(host, failing, pattern, body));
  }
}

}  // namespace fleetproof
