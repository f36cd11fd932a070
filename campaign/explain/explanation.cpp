#include "campaign/explain/explanation.hpp"

#include <algorithm>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"

namespace fleetproof {
namespace {

// A run that ends with its failure would not show a failure that comes a little later.
constexpr Duration kLonger = std::chrono::seconds(30);

// The smallest case with time for the failure to come later. If it fails otherwise then, the case as it is.
FailingCase with_more_time(CaseHost& host, const FailingCase& small, const FailingCase& original,
                           const FailurePattern& pattern) {
  FailingCase longer = small;
  longer.scenario.horizon = std::min(small.scenario.horizon + kLonger, original.scenario.horizon);
  const auto failure = pattern.match(host(longer.scenario));
  if (!failure) return small;
  longer.failure = *failure;
  return longer;
}

// Of the AGVs of the failure that were on no drive then.
std::vector<Departure> past_drives(const Explanation& of, const Itinerary& itinerary) {
  std::vector<Departure> found;
  for (const EntityId body : {of.small.failure.a, of.small.failure.b}) {
    if (!body.valid() || std::ranges::count(of.set_offs, body, &SetOff::agv) > 0) continue;
    const Departure* last = last_departure(itinerary.departures, body, of.small.failure.at);
    if (last != nullptr) found.push_back(*last);
  }
  return found;
}

}  // namespace

Explanation explain(CaseHost& host, const FailingCase& original, const FailingCase& small,
                    const FailurePattern& pattern) {
  Explanation found;
  found.original = original;
  found.pattern = pattern;
  found.small = with_more_time(host, small, original, pattern);
  found.messages = needs_of_messages(host, found.small, pattern);
  found.things = without_each_thing(host, found.small, pattern);
  found.stops = last_stops(host, found.small, pattern);
  found.set_offs = set_offs(host, found.small, pattern);
  CaseRun run = host(found.small.scenario, Deliveries::Kept);
  found.past_drives = past_drives(found, run.itinerary);
  found.notes = std::move(run.notes);
  found.doing = std::move(run.doing);
  found.ended = std::move(run.outcome.message);
  CaseRun undisturbed = host(with_deliveries_only(found.small.scenario, {}));
  if (!failure_of(undisturbed)) found.undisturbed_words = std::move(undisturbed.all_words);
  found.shares = shares_of(host, original, pattern);
  found.no_return = curve_of_no_return(host, original, pattern);
  return found;
}

std::vector<const Claim*> claims_of(const Explanation& explanation) {
  std::vector<const Claim*> claims;
  const auto add = [&](const std::vector<Claim>& more) {
    for (const Claim& claim : more) claims.push_back(&claim);
  };
  for (const MessageNeed& need : explanation.messages) add(need.claims);
  add(explanation.things);
  for (const LastStop& stop : explanation.stops) add(stop.claims);
  for (const SetOff& set_off : explanation.set_offs) {
    for (const Leave& leave : set_off.leaves) {
      add(leave.claims);
      if (leave.without_others) claims.push_back(&*leave.without_others);
      for (const GoAhead& key : leave.keys) claims.push_back(&key.claim);
    }
  }
  return claims;
}

}  // namespace fleetproof
