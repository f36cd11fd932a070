#include "campaign/explain/no_return.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaign/explain/set_offs.hpp"
#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/other_draws.hpp"

namespace fleetproof {
namespace {

constexpr double kLast_s = 0.2, kFirst_s = 60.0;  // before the failure
constexpr Duration kWatchedAfter = std::chrono::seconds(5);

// From far to near: each is a fixed share of the one before, so that the last seconds are looked at closely. Built by
// multiplication alone, as all that a result rests on.
std::vector<SimTime> instants_before(SimTime failure) {
  const double first_s = std::min(kFirst_s, to_seconds(failure - kStart));
  if (first_s <= kLast_s) return {kStart};
  double share = 0.5;  // the kInstants - 1st root of last / first, by halving
  for (double step = 0.25; step > 1e-12; step /= 2.0) {
    double last_s = first_s;
    for (std::size_t i = 1; i < kInstants; ++i) last_s *= share;
    share += last_s < kLast_s ? step : -step;
  }
  std::vector<SimTime> instants;
  double before_s = first_s;
  for (std::size_t i = 0; i < kInstants; ++i, before_s *= share) instants.push_back(failure - seconds(before_s));
  return instants;
}

// Whether so many branches that fail are no more than `before`, but for two standard errors of the difference.
bool is_as_before(std::size_t failing, std::size_t before) {
  if (failing <= before) return true;
  const std::size_t more = failing - before, sum = failing + before;
  return more * more * 2 * kBranches <= 4 * sum * (2 * kBranches - sum);
}

// A run in which many fail, at any time, says nothing about what decided this failure.
bool is_of_same_bodies(const Failure& a, const Failure& b) {
  return (a.a == b.a && a.b == b.b) || (a.a == b.b && a.b == b.a);
}

std::optional<SimTime> last_set_off(const CaseRun& run, const Failure& failure) {
  std::optional<SimTime> last;
  for (const Departure& drive : failed_drives(run, failure)) last = std::max(last.value_or(drive.at), drive.at);
  return last;
}

}  // namespace

NoReturn judged(std::vector<Branching> curve) {
  NoReturn found;
  found.open_until = curve.front().at;
  for (const Branching& branching : curve) {
    const bool is_certain = branching.failing() == kBranches;
    if (!is_certain && is_as_before(branching.failing(), curve.front().failing())) found.open_until = branching.at;
    if (2 * branching.failing() < kBranches) found.likely_from.reset();
    if (2 * branching.failing() >= kBranches && !found.likely_from) found.likely_from = branching.at;
    if (!is_certain) found.certain_from.reset();
    if (is_certain && !found.certain_from) found.certain_from = branching.at;
  }
  found.curve = std::move(curve);
  return found;
}

NoReturn curve_of_no_return(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern) {
  Scenario scenario = failing.scenario;
  scenario.horizon = std::min(scenario.horizon, failing.failure.seen - kStart + kWatchedAfter);
  const CaseRun whole = host(scenario, Deliveries::Kept);
  std::vector<Branching> curve;
  for (const SimTime at : instants_before(failing.failure.at)) {
    Branching& branching = curve.emplace_back(Branching{at, scenario, {}});
    branching.run.deliveries.clear();
    for (const MessageDelivery& message : whole.deliveries) {
      if (kStart + message.delivery.sent < at) branching.run.deliveries.push_back(message.delivery);
    }
  }
  const auto draw = [](std::size_t rank) { return static_cast<std::uint32_t>(rank % kBranches + 1); };
  const auto branch = [&](std::size_t rank) {
    return std::optional(with_other_radio(curve[rank / kBranches].run, draw(rank)));
  };
  const auto runs = all_runs(host, {curve.size() * kBranches, branch});
  for (std::size_t rank = 0; rank < runs.size(); ++rank) {
    const auto failure = pattern.match(*runs[rank]);
    if (failure && is_of_same_bodies(*failure, failing.failure))
      curve[rank / kBranches].failing_draws.push_back(draw(rank));
  }
  NoReturn found = judged(std::move(curve));
  const auto set_off = last_set_off(whole, failing.failure);
  if (set_off && found.certain_from && *set_off > *found.certain_from) found.acted_by = set_off;
  return found;
}

}  // namespace fleetproof
